"""Equilibria of meshes in memory, with energies of the caller's own beside those of the library."""
import numpy as np
import pytest
import scipy.optimize
import scipy.sparse

import coapt
from coapt import metrics
from meshes import ELASTIC, square
from term_test import SparseSprings, Springs
from valves import MeanSquare, scene_file, slope

V, F = square(5)
CORNER, MIDDLE = [0, 1, 6], [14, 15, 20]  # held, and free
SETS = {"sets": {"corner": CORNER, "middle": MIDDLE}}
PARAMETERS = ["cst_stvk.stiffness", "load_pressure.pressure", "corner.shift", "middle.rest"]
PRESSURE = {"type": "load_pressure", "value": "2 kPa"}
WEIGHT = {"type": "load_field", "name": "weight", "direction": [0.3, 0, -1], "force": "0.01 N", "nodes": "all"}


def followed(terms, parameters=PARAMETERS, **options):
    eq = coapt.Equilibrium.of(V, F, terms, parameters, fixed="boundary", scene=SETS, tol=1e-11, **options)
    assert eq.solve().success
    return eq


def expect_exact_derivatives(eq, step=2e-3):
    """By every number, of metrics of ours and one of one's own, against differences of solved shapes."""
    own = [metrics.strain_energy(eq), metrics.node_position(eq, MIDDLE, [0.2, -0.3, 1.0]), MeanSquare(count=30)]
    start, exact = eq.value, eq.jacobian(own)

    def at(direction):
        def shape(h):
            eq.value = start + h * direction
            assert eq.solve().success
            return eq.evaluate(own)
        return shape

    for k, scale in enumerate(np.where(start == 0, 0.1, np.maximum(np.abs(start), 1e-4))):
        direction = scale * (np.arange(start.size) == k)
        found = slope(at(direction), step)
        assert np.abs(exact @ direction - found).max() <= 1e-6 * np.abs(exact * scale).max(), (k, exact @ direction, found)
    eq.value = start
    assert eq.solve().success and np.abs(exact).max(axis=1).min() > 1e-3


def test_a_mesh_in_memory_is_followed_as_that_of_a_file_is(tmp_path):
    with open(tmp_path / "square.obj", "w") as file:
        file.writelines(f"v {x} {y} {z}\n" for x, y, z in V)
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in F + 1)
    terms = [ELASTIC, PRESSURE]
    scene = {"mesh": {"file": tmp_path / "square.obj"}, "boundary": [{"nodes": "boundary", "fix": True}],
             "terms": terms, **SETS}
    of_file = coapt.Equilibrium(scene, PARAMETERS, tol=1e-11)
    assert of_file.solve().success
    eq = followed(terms)
    assert eq.parameters == PARAMETERS and eq.available == of_file.available
    assert np.array_equal(eq.x, of_file.x) and eq.x[:, 2].max() > 0.1
    assert np.array_equal(eq.jacobian([MeanSquare(count=30)]), of_file.jacobian([MeanSquare(count=30)]))


@pytest.mark.parametrize("kind", [Springs, SparseSprings])
def test_an_energy_of_ones_own_has_exact_derivatives_beside_ours(kind):
    eq = followed([kind(V, F), ELASTIC, PRESSURE])
    alone = followed([ELASTIC, PRESSURE])
    assert np.abs(eq.x - alone.x).max() > 0.01
    expect_exact_derivatives(eq)
    eq["load_pressure.pressure"] = 1.02 * eq["load_pressure.pressure"]
    warm = eq.solve()
    assert warm.success and warm.is_quick and warm.iterations <= 5


def test_numbers_of_the_scene_leave_ones_own_energy_alone():
    expect_exact_derivatives(followed([ELASTIC, Springs(V, F), PRESSURE], ["cst_stvk.young", "cst_stvk.poisson"]))


def test_a_scene_of_a_file_takes_ones_own_energy_too():
    class Pull(coapt.Term):  # toward the atrium
        role = "contact"

        def value(self, x):
            return 1e-3 * (x[:, 2] ** 2).sum()

        def gradient(self, x):
            return 2e-3 * x * [0, 0, 1]

        def hessian(self, x):
            return scipy.sparse.diags(np.tile([0, 0, 2e-3], len(x)))

    eq = coapt.Equilibrium(scene_file(), ["leaflets.stiffness"], terms=[Pull()], tol=1e-10)
    bare = coapt.Equilibrium(scene_file(), ["leaflets.stiffness"], tol=1e-10)
    assert eq.solve().success and bare.solve().success
    assert 1e-3 < np.abs(eq.x[:60] - bare.x[:60]).max() < 5
    again = coapt.Equilibrium(scene_file(), terms=[Pull()], x0=eq.x, tol=1e-10)
    assert again.first.iterations <= 1 and np.abs(again.x[:60] - eq.x[:60]).max() < 1e-4


def test_objectives_find_the_number_that_made_a_shape():
    eq = followed([ELASTIC, Springs(V, F), PRESSURE], ["cst_stvk.stiffness"])
    eq.value = [1.3]
    assert eq.solve().success
    residuals = metrics.distance_residuals(eq, eq.x, eq.faces)
    fun, jac = coapt.objective(eq, residuals)
    fit = scipy.optimize.least_squares(fun, [1.0], jac=jac, bounds=(0.5, 2), xtol=1e-9)
    assert fit.x[0] == pytest.approx(1.3, abs=2e-3)


@pytest.mark.parametrize("what", ["load", "forces"])
def test_dead_loads_are_parameters(what):
    eq = followed([{**ELASTIC, "young": "10 MPa"}, Springs(V, F), WEIGHT], [f"weight.{what}"])
    assert f"weight.{what}" in eq.available and eq.loads["weight"].tolist() == list(range(36))
    force = 0.01 * np.array([0.3, 0, -1]) / np.hypot(0.3, 1)
    if what == "load":
        assert eq["weight.load"].tolist() == [1]
        expect_exact_derivatives(eq)
    else:
        assert eq["weight.forces"] == pytest.approx(np.tile(force, (36, 1)), abs=1e-15)
        inner = 14
        gradient = eq.value_and_grad(metrics.node_position(eq, 14, [0, 0, 1]))[1].reshape(-1, 3)
        forces = eq["weight.forces"]

        def height(h):
            eq["weight.forces"] = forces + h * (np.arange(36) == inner)[:, None] * [0, 0, 1e-3]
            assert eq.solve().success
            return eq.x[14, 2]
        assert slope(height, 0.1) == pytest.approx(1e-3 * gradient[inner, 2], rel=1e-6)
        assert gradient[inner, 2] > 0.1 and not gradient[0].any()  # a held node moves nothing
    other = {"load": "forces", "forces": "load"}[what]
    with pytest.raises(coapt.InputError, match=f'"weight.{other}": changes force 0 of term "weight", which "weight.{what}"'):
        eq.add(f"weight.{other}")


class Failing(Springs):
    """Raises at a call that is counted down to."""
    left, error = 0, ArithmeticError("mine")

    def state(self, x):
        self.left -= 1
        if self.left == 0:
            raise self.error
        return super().state(x)


def test_what_a_term_raises_reaches_the_caller_and_leaves_the_numbers_that_were_asked_for():
    term = Failing(V, F)
    eq = followed([ELASTIC, term, PRESSURE])
    start = eq.value
    wanted = start + np.where(start == 0, 0.02, 0.01 * start)
    metric = MeanSquare(count=30)
    eq.value = wanted
    assert eq.solve().success
    expected = eq.value_and_grad(metric)
    raised = 0
    for calls in range(1, 60, 4):
        term.left = 0
        eq.value = start
        assert eq.solve().success
        eq.value = wanted
        term.left = calls
        try:
            eq.solve()
        except ArithmeticError as error:
            assert error is term.error
            raised += 1
            with pytest.raises(coapt.InputError, match=r"solve\(\)"):
                eq.value_and_grad(metric)
        term.left = 0
        assert np.array_equal(eq.value, wanted) and eq.solve().success
        value, gradient = eq.value_and_grad(metric)
        assert value == pytest.approx(expected[0], rel=1e-9) and gradient == pytest.approx(expected[1], rel=1e-6, abs=1e-9)
    assert raised >= 2


def test_a_term_cannot_call_the_equilibrium_that_it_is_part_of():
    class Nosy(Springs):
        eq = None

        def value(self, x):
            if self.eq is not None:
                self.eq.solve()
            return super().value(x)

    term = Nosy(V, F)
    eq = followed([ELASTIC, term, PRESSURE])
    term.eq = eq
    eq.value = eq.value * 1.01
    with pytest.raises(coapt.InputError, match="another call is at work"):
        eq.solve()
    term.eq = None
    assert eq.solve().success


def without_hessian():
    term = Springs(V, F)
    term.hessian = None
    return term


@pytest.mark.parametrize(("call", "pieces"), [
    (lambda: coapt.Equilibrium.of(V.T, F, [ELASTIC, without_hessian()], [7], tol=0),
     ["terms[1] (Springs): has no hessian()", "V: has shape (3, 36)", "parameters[0]", "tol"]),
    (lambda: coapt.Equilibrium(scene_file(), terms=[without_hessian()]), ["terms[0] (Springs): has no hessian()", "lbfgs"]),
    (lambda: coapt.Equilibrium(scene_file(), terms=[ELASTIC]), ["terms: holds a dict"]),
    (lambda: coapt.Equilibrium.of(V, F, []), ["terms: is empty"]),
    (lambda: coapt.Equilibrium.of(V, F, [Springs(V, F), {**ELASTIC, "yuong": "1 MPa"}]), ["terms[1].yuong", "young"]),
    (lambda: coapt.Equilibrium.of(V, F, [ELASTIC, PRESSURE], fixed="boundary", x0=V[:4]), ["has 4 nodes"]),
    (lambda: followed([ELASTIC, PRESSURE], ["cst_stvk.young", "cst_stvk.thickness"]), ["does not go with", "TERM.young"]),
    (lambda: followed([{"type": "spring", "young": "1 MPa", "thickness": "0.1 mm"}, PRESSURE], ["middle.rest"]),
     ['"middle.rest"', "(spring)", "constant-strain triangles"]),
])
def test_bad_input_names_the_argument_and_what_was_expected(call, pieces):
    with pytest.raises(coapt.InputError) as caught:
        call()
    for piece in pieces:
        assert piece in str(caught.value), str(caught.value)
