"""The examples run from top to bottom and find what they say."""
import runpy

import numpy as np
import pytest
from matplotlib import pyplot

from meshes import ROOT


@pytest.fixture
def run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    yield lambda name: runpy.run_path(str(ROOT / "examples/python" / name))
    pyplot.close("all")


def test_closure(run):
    found = run("closure.py")
    result = found["result"]
    assert result.success and result.metrics["intersections"] == 0
    assert result.metrics["orifice_area_mm2"] < 0.1 * result.metrics["annulus_area_mm2"]
    assert 0 < found["touching"] < 1 and found["strongest"] == result.metrics["max_chord_force_n"]


def test_comparing_backends(run):
    found = run("comparing_backends.py")
    assert {"newton", "lbfgs"} <= set(found["runs"]) and found["largest_gap"] < 1e-3
    assert all(result.success for results in found["runs"].values() for result in results)


def test_sail(run):
    found = run("sail.py")
    assert found["result"].success
    assert 0.03 < found["draft"] < 0.2 and found["clew_force"] > 1


def test_tuning(run):
    found = run("tuning.py")
    assert found["fit"].success and found["after"] < 0.02 * found["before"]
    assert found["is_determined"].any() and found["worst"] < 0.05


def test_ring_sweep(run):
    found = run("ring_sweep.py")
    table, eq, width = found["table"], found["eq"], found["width"]
    assert (table[:, 1] > 0).all() and table[0, 1] > 2 * table[-1, 1]
    ring, step, values = eq["annulus.ring"], 1e-5, []
    for sign in (1, -1):
        eq["annulus.ring"] = ring + sign * step * np.array([1, 1, 0, 0])
        assert eq.solve().success
        values.append([eq.evaluate(metric) for metric in found["figures"].values()])
    assert np.subtract(*values) / (2 * step * width) == pytest.approx(table[-1, [2, 4]], rel=1e-4)


def test_every_example_is_tested():
    names = {path.stem for path in (ROOT / "examples/python").glob("*.py")}
    assert names == {"closure", "comparing_backends", "ring_sweep", "sail", "tuning"}
