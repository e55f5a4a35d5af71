"""Energies from expressions: what SymPy differentiates is what the library has by hand, and joins in like any term."""
import pickle
import sys

import numpy as np
import pytest

import coapt
from meshes import PRESSURE, disc, edges, square

sympy = pytest.importorskip("sympy", reason="python3-sympy is not installed: energies from expressions are not tested")

CORD = "t * max((norm(x1 - x0) - r) / rho, 0)**3"
RUBBER = """G = gram(X1 - X0, X2 - X0)
            g = gram(x1 - x0, x2 - x0)
            h * sqrt(det(G)) / 2 * mu / 2 * (trace(inverse(G) * g) + det(G) / det(g) - 3)"""
CABLES = {"type": "tether_cubic", "edges": "all", "length_scale": 0.9, "strength": "0.002 mJ", "scale": "1 mm"}
MEMBRANE = {"type": "cst_neo_hookean", "shear_modulus": "0.33 MPa", "thickness": "0.1 mm", "compression": "resisted"}


def cords(V, F, name="cords"):
    E = edges(F)
    return coapt.energy(CORD, E, t=0.002, r=0.9 * np.linalg.norm(V[E[:, 1]] - V[E[:, 0]], axis=1), rho=1, name=name)


def rubber(V, F):
    return coapt.energy(RUBBER, F, X=V, mu=0.33, h=0.1, name="rubber")


def moved(V, share=0.1):
    return 1.1 * V + share * np.random.default_rng(5).standard_normal(V.shape)


@pytest.mark.parametrize(("ours", "mine"), [(CABLES, cords), (MEMBRANE, rubber)])
def test_the_same_energy_and_gradient_and_shape_as_the_terms_of_the_library(ours, mine):
    V, F = disc(5)
    term = mine(V, F)
    theirs = coapt.minimize(V, F, [ours, PRESSURE], fixed="boundary", tol=1e-10)
    found = coapt.minimize(V, F, [term, PRESSURE], fixed="boundary", tol=1e-10)
    assert theirs.success and found.success and np.ptp(found.x[:, 2]) > 0.3
    assert np.abs(found.x - theirs.x).max() < 1e-8
    name = ours["type"]
    assert term.value(theirs.x) == pytest.approx(theirs.energies[name], rel=1e-10)
    held = np.linalg.norm(V, axis=1) > 9.99
    assert term.gradient(theirs.x)[held] == pytest.approx(theirs.reactions[held], abs=1e-10)
    assert np.linalg.norm(theirs.reactions[held]) > 1e-3
    assert found.certificate["stability"] == theirs.certificate["stability"] == "strict_minimum"


@pytest.mark.parametrize("mine", [cords, rubber])
def test_derivatives_are_those_of_the_energy(mine):
    V, F = square(4)
    report = coapt.check_term(mine(V, F), moved(V))
    assert report["passed"] and report["hessian_slope"] > 2.9 and report["gradient_norm"] > 0, report


RANDOM = np.random.default_rng(2)


@pytest.mark.parametrize(("text", "data"), [
    ("k / 2 * dot(x0 - a, x0 - a)", {"k": 2.0, "a": RANDOM.random((3, 3))}),  # a place: no function of differences
    ("where(norm(x1 - x0) < 1, k * norm(x1 - x0)**2, k * (2 * norm(x1 - x0) - 1))", {"k": [0.5, 1, 2]}),
    ("n = cross(x1 - x0, x2 - x0); k * abs(dot(n, x3 - x0)) + min(k, norm(n), 3)**2", {"k": [0.5, 1, 2]}),
    ("u = transpose(columns(x1 - x0, x2 - x0)) * (x3 - x0); dot(u, B * u) + exp(-pi * trace(B)) * sin(x0[0])",
     {"B": RANDOM.random((3, 2, 2))}),
    ("sqrt(1 + norm(x1 - x2)**2) * atan2(x3[1], 2 + x0[2]**2) + log(k + x1[0]**2)**-2", {"k": 3.0}),
    # more pieces than there may be branches
    ("+".join(f"max({k} + dot(x{k % 2}, x{(k + 1) % 2}), 0)**3" for k in range(5)), {}),
])
def test_every_part_of_the_language_has_exact_derivatives(text, data):
    x = np.random.default_rng(2).uniform(0.5, 2, (6, 3))
    elements = np.array([[0, 1, 2, 3], [2, 3, 4, 5], [5, 4, 1, 0]])
    term = coapt.energy(text, elements, **data)
    report = coapt.check_term(term, x, step=0.01)
    assert report["passed"] and report["gradient_norm"] > 0, report
    assert term.element_energies(x).shape == (3,)
    assert term.hessian(x) == pytest.approx(term.hessian(x).swapaxes(1, 2), abs=1e-12)


def test_a_text_and_sympy_say_the_same():
    V, F = square(3)
    p, q = coapt.symbolic.nodes(2)
    t, r = sympy.symbols("t r")
    lengths = np.linspace(2, 3, len(edges(F)))
    written = coapt.energy("t * (norm(x1 - x0) - r)**2", edges(F), t=0.4, r=lengths)
    built = coapt.energy(t * ((q - p).norm() - r) ** 2, edges(F), t=0.4, r=lengths)
    x = moved(V)
    assert built.value(x) == pytest.approx(written.value(x), rel=1e-14) and written.value(x) > 0.1
    assert np.allclose(built.hessian(x), written.hessian(x), rtol=1e-12, atol=1e-14)


def test_a_slack_cord_of_no_length_has_no_force_and_breaks_nothing():
    x = np.zeros((2, 3))
    cord = coapt.energy(CORD, [[0, 1]], t=1, r=1, rho=1)
    assert cord.value(x) == 0 and not cord.gradient(x).any() and not cord.hessian(x).any()


def test_a_state_without_energy_is_not_admissible():
    term = coapt.energy("-log(x0[2])", [[0]])
    assert term.value(np.array([[0, 0, -1.0]])) == np.inf
    assert term.value(np.array([[0, 0, np.e]])) == pytest.approx(-1)
    V, F = square(3)
    wall = coapt.energy("-mu * log(1 + x0[2])", np.arange(len(V))[:, None], mu=1e-4, role="contact", name="wall")
    pushed = coapt.minimize(V, F, [MEMBRANE, wall, {**PRESSURE, "value": "-10 kPa"}], fixed="boundary", tol=1e-8)
    assert pushed.success and -1 < pushed.x[:, 2].min() < -0.5


def test_energies_without_names_join_each_other():
    V, F = disc(5)
    E = edges(F)
    unnamed = [coapt.energy(RUBBER, F, X=V, mu=0.33, h=0.1),
               coapt.energy(CORD, E, t=0.002, r=0.9 * np.linalg.norm(V[E[:, 1]] - V[E[:, 0]], axis=1), rho=1)]
    found = coapt.minimize(V, F, [*unnamed, PRESSURE], fixed="boundary", tol=1e-10)
    assert found.success and list(found.energies)[-2:] == ["energy", "energy_2"] and min(found.energies["energy"], found.energies["energy_2"]) > 0
    named = coapt.minimize(V, F, [rubber(V, F), cords(V, F), PRESSURE], fixed="boundary", tol=1e-10)
    assert np.abs(found.x - named.x).max() < 1e-12
    assert [term.name for term in unnamed] == ["energy", "energy"]  # they are the caller's
    eq = coapt.Equilibrium.of(V, F, [*unnamed, PRESSURE], ["load_pressure.pressure"], fixed="boundary")
    assert pickle.loads(pickle.dumps(eq)).solve().success
    with pytest.raises(coapt.InputError, match='term "cords": another term has this name too'):
        coapt.minimize(V, F, [rubber(V, F), cords(V, F), cords(V, F), PRESSURE], fixed="boundary")


def test_energies_join_an_equilibrium_and_pickle():
    V, F = disc(3)
    eq = coapt.Equilibrium.of(V, F, [rubber(V, F), PRESSURE], ["load_pressure.pressure"], fixed="boundary")
    assert eq.solve().success
    eq["load_pressure.pressure"] = 1.2 * eq["load_pressure.pressure"]
    assert eq.solve().is_quick
    term = rubber(V, F)
    again = pickle.loads(pickle.dumps(term))
    x = moved(V)
    assert again.value(x) == term.value(x) and again.name == "rubber"
    assert np.array_equal(again.hessian(x), term.hessian(x))


@pytest.mark.parametrize(("text", "piece"), [
    ("k * nrm(x1 - x0)", r"nrm\(\.\.\.\) is not known; did you mean 'norm'"),
    ("k * (x1 - x0)", "is a vector or a matrix; expected one number"),
    ("k + lenght", r"'lenght' is not known; it has x0, x1, k; give data as lenght="),
    ("K * norm(x1 - x0)", "'K' is not known; did you mean 'k'"),
    ("a = 1", "the energy in the last line"),
    ("k = 3; k", "'k' has a meaning already"),
    ("x1[7] * k", r"'x1\[7\]' names no entry"),
    ("x1 * x0", "'x1 \\* x0': .*mismatch"),
    ("norm(k)", "vectors of as many coordinates"),
    ("sqrt(k, 2)", "another number of arguments than 2"),
    ("1 +", "cannot be read in line 1"),
    ("__import__('os').system('true')", "is not part of the language"),
    ("k.free_symbols", "is not part of the language"),
    ("[k for k in (1, 2)]", "is not part of the language"),
])
def test_what_cannot_be_read_is_named(text, piece):
    with pytest.raises(coapt.InputError, match=piece):
        coapt.energy(text, [[0, 1]], k=1.0)


@pytest.mark.parametrize(("arguments", "piece"), [
    ({"elements": [0, 1]}, r"elements: has shape \(2,\)"),
    ({"elements": [[0.5, 1]]}, "elements: has shape .* of float64"),
    ({"elements": [[-1, 1]]}, "counted from 0"),
    ({"k": [1, 2]}, r"k: has shape \(2,\); expected a number, or real numbers of shape \(1, ...\)"),
    ({"k": np.nan}, "k: holds a number that is not finite"),
    ({"k_": 1}, "is no name for data"),
    ({"x0_1": 1}, "x0_1: has a meaning"),
    ({"norm": 1}, "norm: has a meaning"),
    ({"X": np.zeros((1, 3))}, "node 1 does not exist; there are 1"),
    ({"X": np.zeros((3, 2))}, r"X: has shape \(3, 2\)"),
])
def test_data_that_do_not_fit_are_named(arguments, piece):
    with pytest.raises(coapt.InputError, match=piece):
        coapt.energy("k * norm(x1 - x0)", **{"elements": [[0, 1]], "k": 1, **arguments})


def test_sympy_alone_has_what_is_not_known_refused():
    p, q = coapt.symbolic.nodes(2)
    with pytest.raises(coapt.InputError, match="'m' is not known; give data as m="):
        coapt.energy(sympy.Symbol("m") * (q - p).norm(), [[0, 1]])
    with pytest.raises(coapt.InputError, match="without a formula"):
        coapt.energy(sympy.Function("f")(p[0]), [[0, 1]])
    with pytest.raises(coapt.InputError, match="node 3 does not exist"):
        coapt.energy((q - p).norm(), [[0, 3]]).value(np.zeros((2, 3)))


def test_without_sympy_the_package_works_and_says_what_is_missing(monkeypatch):
    monkeypatch.setitem(sys.modules, "sympy", None)
    with pytest.raises(ImportError, match="python3-sympy"):
        coapt.energy("x0[0]", [[0]])
