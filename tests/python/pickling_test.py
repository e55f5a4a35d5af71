"""Results and equilibria go to other processes and come back."""
import copy
import multiprocessing
import os
import pickle

import numpy as np
import pytest

import coapt
from meshes import ELASTIC, PRESSURE, disc
from term_test import Springs
from valves import followed, scene_file


def copied(of):
    return pickle.loads(pickle.dumps(of))


@pytest.mark.parametrize("copies", [copied, copy.deepcopy])
def test_a_result_is_the_same_in_every_field(copies):
    result = coapt.solve(scene_file(), branches=0)
    again = copies(result)
    assert type(again) is coapt.Result and again.status is coapt.Status.CONVERGED and list(again) == list(result)
    for name in ("x", "jac", "faces", "lines", "history", "reactions", "undetermined"):
        assert np.array_equal(again[name], result[name]) and not np.shares_memory(again[name], result[name])
    assert again.metrics == result.metrics and again.document == result.document and repr(again) == repr(result)
    assert all(np.array_equal(again.fields[name], values, equal_nan=values.dtype.kind == "f")
               for name, values in result.fields.items())
    assert coapt.plot.shape(again) is not None


def test_an_equilibrium_stands_where_it_stood():
    eq = followed()
    eq["chords.length"] = 0.97
    eq["papillary.shift"] = [0.3, -0.2, 0.1]
    assert eq.solve().success
    again = copied(eq)
    assert again.parameters == eq.parameters and np.array_equal(again.value, eq.value)
    assert np.abs(again.x - eq.x).max() < 1e-7 * np.ptp(eq.x)
    orifice, theirs = coapt.metrics.orifice_area(eq), coapt.metrics.orifice_area(again)
    value, slope = eq.value_and_grad(orifice)
    their_value, their_slope = again.value_and_grad(theirs)  # it is solved: no call before this one
    assert their_value == pytest.approx(value, rel=1e-8) and their_slope == pytest.approx(slope, rel=1e-5, abs=1e-6)
    ours, check = eq.check_anchor(), again.check_anchor()  # the anchor went along: both ways lead where they led
    assert check.is_same_branch == ours.is_same_branch and check.travel == pytest.approx(ours.travel, rel=1e-6)
    assert check.back == pytest.approx(ours.back, abs=1e-6) and check.here == pytest.approx(ours.here, abs=1e-6)
    again["chords.length"] = 0.96
    assert again.solve().is_quick and eq["chords.length"] == 0.97
    assert np.abs(copied(again).x - again.x).max() < 1e-7 * np.ptp(eq.x)


def test_numbers_that_were_not_solved_for_wait_in_the_copy_too():
    eq = followed(["chords.length"])
    x = eq.x
    eq["chords.length"] = 0.95
    again = copied(eq)
    assert again["chords.length"] == 0.95 and np.abs(again.x - x).max() < 1e-7 * np.ptp(x)
    with pytest.raises(coapt.InputError, match="solve"):
        again.value_and_grad(coapt.metrics.strain_energy(again))
    assert again.solve().success and eq.solve().success
    assert np.abs(again.x - eq.x).max() < 1e-7 * np.ptp(x)


def test_one_that_was_never_solved_for_is_copied_as_it_is():
    eq = coapt.Equilibrium(scene_file(), ["chords.length"])
    again = copied(eq)
    assert np.abs(again.x - eq.x).max() < 1e-5 * np.ptp(eq.x)
    eq.add("leaflets.stiffness")
    assert eq.solve().success
    again = copied(eq)
    assert again.parameters == ["chords.length", "leaflets.stiffness"]
    assert eq.check_anchor().is_same_branch and again.check_anchor().is_same_branch


def test_a_shape_on_another_branch_comes_back_on_it():
    # A shallow dome that snaps: two shapes for the same numbers, and the copy is on the one that was left.
    V, F = disc(4)
    V[:, 2] = 0.8 * (1 - (V[:, 0] ** 2 + V[:, 1] ** 2) / 100)
    stiff = {"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"}
    bend = {"type": "bending"}
    eq = coapt.Equilibrium.of(V, F, [stiff, bend, {"type": "load_pressure", "value": "0.0001 kPa", "model": "frozen"}],
                              ["load_pressure.load"], fixed="boundary", tol=1e-8)
    assert eq.solve().success and eq.x[0, 2] > 0.5
    for load in (-10, -20, -25, 0.5):
        eq["load_pressure.load"] = load
        assert eq.solve().success
    assert eq.x[0, 2] < -0.5
    again = copied(eq)
    assert again.x[0, 2] == pytest.approx(eq.x[0, 2], abs=1e-6)
    assert not again.check_anchor().is_same_branch and not eq.check_anchor().is_same_branch


def test_meshes_and_terms_of_ones_own_go_along_as_they_were():
    V, F = disc(3)
    fixed = np.linalg.norm(V, axis=1) > 9.99
    pressure = dict(PRESSURE)
    eq = coapt.Equilibrium.of(V, F, [ELASTIC, Springs(V.copy(), F), pressure], ["load_pressure.pressure"], fixed=fixed,
                              scene={"sets": {"middle": np.array([0])}})
    assert eq.solve().success
    V[:], F[:], fixed[:], pressure["value"] = 0, 0, False, "9 kPa"  # what becomes of the caller's own changes nothing
    again = copied(eq)
    assert np.abs(again.x - eq.x).max() < 1e-9 and again.sets["middle"].tolist() == [0]
    assert np.abs(copy.deepcopy(eq).x - eq.x).max() < 1e-9


def orifice_of(eq):
    return os.getpid(), eq.evaluate(coapt.metrics.orifice_area(eq)), eq.solve().iterations


def test_another_process_takes_it(tmp_path, monkeypatch):
    monkeypatch.chdir(scene_file().parent)
    eq = coapt.Equilibrium("scene.json", ["chords.length"])  # a relative path, which is another one elsewhere
    assert eq.solve().success
    monkeypatch.chdir(tmp_path)
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        process, area, iterations = pool.apply(orifice_of, (eq,))
    assert process != os.getpid() and iterations == 0
    assert area == pytest.approx(eq.evaluate(coapt.metrics.orifice_area(eq)), rel=1e-8)
