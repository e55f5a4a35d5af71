"""Meshes in memory: answers, shapes of results, callbacks and errors."""
import os
import pickle
import sys

import numpy as np
import pytest

import coapt
from coapt import _core
from meshes import ELASTIC, PRESSURE, disc, square

TERMS = [ELASTIC, PRESSURE]


@pytest.fixture(scope="module")
def inflated():
    return coapt.minimize(*disc(12), TERMS, fixed="boundary", tol=1e-8)


def test_an_inflated_disc_is_as_high_as_theory_says(inflated):
    assert inflated.success and inflated.status == coapt.Status.CONVERGED and inflated.residual <= 1e-8
    assert inflated.x[0, 2] == pytest.approx(1.4138, rel=5e-3)  # axisymmetric equations


def test_a_result_is_shaped_as_those_of_scipy(inflated):
    scipy_names = ("x", "fun", "jac", "nit", "nfev", "njev", "nhev", "success", "status", "message")
    assert all(name in inflated and inflated[name] is getattr(inflated, name) for name in scipy_names)
    assert inflated.x.shape == inflated.jac.shape == inflated.reactions.shape == (469, 3)
    assert inflated.nit == inflated.history["iteration"][-1] and inflated.nfev >= inflated.njev >= inflated.nhev > 0
    assert inflated.fun == pytest.approx(sum(inflated.energies.values()), rel=1e-12)
    assert inflated.certificate["stability"] == "strict_minimum"
    assert inflated.metrics["leaflet_area_closed_mm2"] > inflated.metrics["leaflet_area_open_mm2"]
    assert "converged" in repr(inflated)
    with pytest.raises(AttributeError, match="has no 'orifice'"):
        inflated.orifice


def test_forces_balance_and_the_gradient_is_that_of_the_residual(inflated):
    rim = np.hypot(*inflated.x[:, :2].T) > 9.999
    assert not inflated.jac[rim].any() and not inflated.reactions[~rim].any()
    assert np.linalg.norm(inflated.jac, axis=1).max() <= 1e-8 * np.linalg.norm(inflated.reactions, axis=1).max()
    a, b, c = inflated.x[inflated.faces].transpose(1, 0, 2)
    push = 1e-4 * np.cross(b - a, c - a) / 6  # of the pressure on each corner of each triangle [N]
    on_free = (push[:, None] * ~rim[inflated.faces][:, :, None]).sum(axis=(0, 1))
    assert on_free[2] > 0.02
    assert inflated.reactions.sum(axis=0) == pytest.approx(-on_free, abs=1e-9)


def test_arrays_look_into_the_result_and_outlive_it(inflated):
    assert all(array.base is not None for array in (inflated.x, inflated.jac, inflated.faces, inflated.history))
    x = coapt.minimize(*disc(2), TERMS, fixed="boundary").x
    assert np.isfinite(x).all() and x[0, 2] > 1
    again = pickle.loads(pickle.dumps(inflated))
    assert np.array_equal(again.x, inflated.x) and again.success


def test_supports_may_be_numbers_masks_or_single_coordinates():
    V, F = square(4)
    rim = (V[:, :2] % 10 == 0).any(axis=1)
    named = coapt.minimize(V, F, TERMS, fixed="boundary")
    for fixed in (np.flatnonzero(rim), rim, np.repeat(rim[:, None], 3, axis=1)):
        assert np.array_equal(coapt.minimize(V, F, TERMS, fixed=fixed).x, named.x)
    sliding = np.zeros((len(V), 3), bool)
    sliding[rim] = True
    sliding[V[:, 0] == 0, 1] = False  # free along one side
    sliding[0] = sliding[4] = True
    moved = coapt.minimize(V, F, TERMS, fixed=sliding)
    assert moved.success and np.array_equal(moved.x[sliding], V[sliding])
    assert abs(moved.x - V)[V[:, 0] == 0, 1].max() > 1e-3


def test_a_start_at_the_solution_needs_no_iteration(inflated):
    again = coapt.minimize(*disc(12), TERMS, fixed="boundary", tol=1e-6, x0=inflated.x)
    assert again.success and again.nit == 0
    assert np.abs(again.x - inflated.x).max() < 1e-12


def test_regions_are_named_in_memory():
    V, F = square(2)
    half = np.where(V[F].mean(axis=1)[:, 0] < 5, "left", "right")
    terms = [{**ELASTIC, "name": "soft", "region": "left"}, {**ELASTIC, "name": "stiff", "region": "right",
                                                            "young": "50 MPa"}, PRESSURE]
    result = coapt.minimize(V, F, terms, fixed="boundary", regions=half)
    assert result.energies["stiff"] > 5 * result.energies["soft"] > 0
    assert result.x[4, 0] > 5.003  # the middle moves to the stiff side


def test_the_callback_sees_every_iterate_and_may_end_the_run():
    seen = []
    result = coapt.minimize(*disc(4), TERMS, fixed="boundary", callback=seen.append)
    assert [at.iteration for at in seen] == result.history["iteration"].tolist()
    assert np.array_equal(seen[-1].x, result.x) and seen[0].x is not seen[0].x
    assert [at.residual for at in seen] == result.history["residual"].tolist()

    ended = coapt.minimize(*disc(4), TERMS, fixed="boundary", callback=lambda at: at.iteration < 2)
    assert ended.status == coapt.Status.CANCELLED and not ended.success and ended.nit == 2

    def stop(at):
        raise StopIteration
    assert coapt.minimize(*disc(4), TERMS, fixed="boundary", callback=stop).status == coapt.Status.CANCELLED


def test_what_a_callback_raises_reaches_the_caller():
    error = LookupError("mine")

    def fail(at):
        raise error
    with pytest.raises(LookupError) as caught:
        coapt.minimize(*disc(4), TERMS, fixed="boundary", callback=fail)
    assert caught.value is error


def test_no_convergence_is_a_result_and_no_error():
    result = coapt.minimize(*disc(4), TERMS, fixed="boundary", scene={"solver": {"max_iterations": 1}})
    assert not result.success and result.status == coapt.Status.ITERATION_LIMIT and result.residual > 1e-6


def test_every_defect_of_the_arguments_is_said_in_one_pass():
    V, F = square(2)
    with pytest.raises(coapt.InputError) as caught:
        coapt.minimize(V.T, F, [ELASTIC, 7], tol=-1, callback=3, scene={"mesh": {}})
    said = {defect.split(":")[0] for defect in caught.value.defects}
    assert said == {"V", "terms[1]", "tol", "callback", "scene"}
    assert "has shape (3, 9)" in str(caught.value) and "transpose it" in str(caught.value)
    assert isinstance(caught.value, ValueError)
    assert pickle.loads(pickle.dumps(caught.value)).defects == caught.value.defects


@pytest.mark.parametrize(("arguments", "pieces"), [
    ({"V": "text"}, ["V: has dtype", "real numbers of shape (n, 3)"]),
    ({"V": [[0, 0], [1]]}, ["V: cannot become an array"]),
    ({"F": np.zeros((4, 3))}, ["F: has dtype float64", "whole numbers"]),
    ({"F": [[0, 1, 99]]}, ["F: triangle 0 has corners [0, 1, 99]", "9 vertices"]),
    ({"F": [[0, 1, 1]]}, ["mesh in memory", "twice"]),
    ({"V": np.full((9, 3), np.nan)}, ["mesh in memory", "finite"]),
    ({"fixed": [0.5]}, ["fixed: has dtype float64"]),
    ({"fixed": np.ones(4, bool)}, ["fixed: has shape (4,)", "shape (9,) or (9, 3)"]),
    ({"fixed": [99]}, ["node 99 does not exist"]),
    ({"x0": np.zeros((4, 3))}, ["has 4 nodes; the scene has 9"]),
    ({"regions": ["a"]}, ["regions: has shape (1,)"]),
    ({"terms": []}, ["terms: is empty"]),
    ({"terms": [{**ELASTIC, "yuong": "1 MPa"}]}, ["terms[0].yuong", "young"]),
    ({"method": "newtn"}, ["newtn", "newton"]),
    ({"scene": {"solver": {"tolerance": float("nan")}}}, ["scene:", "JSON"]),
])
def test_bad_input_names_the_argument_and_what_was_expected(arguments, pieces):
    V, F = square(2)
    with pytest.raises(coapt.InputError) as caught:
        coapt.minimize(**{"V": V, "F": F, "terms": TERMS, "fixed": "boundary", **arguments})
    for piece in pieces:
        assert piece in str(caught.value)


def resident_mb():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def test_arrays_go_in_without_a_copy():
    V, F = np.ones((2_000_000, 3)), np.zeros((1_000_000, 3), np.int32)
    F[:] = [0, 1, 2]
    before, counts = resident_mb(), (sys.getrefcount(V), sys.getrefcount(F))
    given = _core.Input(text="{}", file="scene", vertices=V, triangles=F, regions=[], region_names=[], start=V, terms=[])
    assert (sys.getrefcount(V), sys.getrefcount(F)) == (counts[0] + 2, counts[1] + 1)  # they themselves are kept
    assert resident_mb() - before < 5, "of 108 MB"
    del given


def test_arrays_come_out_without_a_copy():
    membrane = {**ELASTIC, "type": "cst_tension_field"}
    result = coapt.minimize(*disc(4), [membrane, PRESSURE, {"type": "cable", "edges": "boundary", "tension": "1 mN"}],
                            fixed="boundary")
    arrays = {"lines": result.lines, "faces": result.faces, "reactions": result.reactions, **result.fields}
    assert {"regime", "line_force", "displacement"} <= arrays.keys()
    for name, array in arrays.items():
        assert array.base is not None and not array.flags.owndata, name
    assert result.lines.shape == (24, 2) and (result.lines >= 0).all()
    rim = np.hypot(*result.x[:, :2].T) > 9.999
    assert rim[result.lines].all() and rim.sum() == 24 == len(np.unique(result.lines))
    assert result.fields["regime"].dtype == np.int32 and set(np.unique(result.fields["regime"])) <= {0, 1, 2}
