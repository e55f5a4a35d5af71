"""Figures, and the shape for meshio."""
import sys

import numpy as np
import pytest

import coapt
from coapt import plot
from meshes import ELASTIC, PRESSURE, ROOT, disc


@pytest.fixture(scope="module")
def runs():
    return {method: [coapt.minimize(*disc(4), [ELASTIC, PRESSURE], fixed="boundary", method=method, tol=tol)
                     for tol in (1e-2, 1e-8)] for method in ("newton", "lbfgs")}


def test_convergence_draws_the_residual_of_every_iterate(runs):
    axes = plot.convergence({name: results[1] for name, results in runs.items()}, against="evaluations")
    assert [line.get_label() for line in axes.get_lines()] == ["newton", "lbfgs"]
    result = runs["newton"][1]
    drawn = axes.get_lines()[0]
    assert np.array_equal(drawn.get_xdata(), result.history["evaluations"])
    assert np.array_equal(drawn.get_ydata(), result.history["residual"])
    assert len(plot.convergence(result).get_lines()) == 1
    with pytest.raises(coapt.InputError, match="against: is 'hours'"):
        plot.convergence(result, against="hours")


def test_work_precision_draws_time_over_error(runs):
    truth = coapt.minimize(*disc(4), [ELASTIC, PRESSURE], fixed="boundary", method="lbfgs", tol=1e-11)
    axes = plot.work_precision(runs, truth=truth)
    for line, results in zip(axes.get_lines(), runs.values()):
        coarse, fine = line.get_xdata()
        assert coarse > 100 * fine > 0
        assert list(line.get_ydata()) == [result.seconds for result in results]
    assert plot.work_precision(runs).get_lines()[0].get_xdata()[0] == runs["newton"][0].residual
    with pytest.raises(coapt.InputError, match="has 61 nodes; truth has 7"):
        plot.work_precision(runs, truth=coapt.minimize(*disc(1), [ELASTIC, PRESSURE], fixed="boundary"))


def test_meshio_gets_the_shape_with_its_fields(tmp_path):
    meshio = pytest.importorskip("meshio")
    chain = coapt.solve(ROOT / "examples/03_catenary/scene.json").to_meshio()
    assert list(chain.cells_dict) == ["line"] and (chain.cell_data["line_force"][0] > 0).all()
    result = coapt.minimize(*disc(4), [ELASTIC, PRESSURE, {"type": "cable", "edges": "boundary", "tension": "1 mN"}],
                            fixed="boundary", folder=tmp_path / "out", report=False)
    mesh = result.to_meshio()
    assert np.array_equal(mesh.points, result.x)
    assert len(mesh.cells_dict["triangle"]) == 96 and len(mesh.cells_dict["line"]) == 24
    mesh.write(tmp_path / "closed.vtu")
    again = meshio.read(tmp_path / "closed.vtu")
    assert np.allclose(again.point_data["displacement"], result.fields["displacement"])
    stress = again.cell_data["principal_stress"]
    assert np.allclose(stress[0], result.fields["principal_stress"]) and np.isnan(stress[1]).all()
    assert np.allclose(again.cell_data["cauchy_stress"][0], result.fields["cauchy_stress"])
    assert len(again.cell_data["line_stress"][1]) == len(result.lines)


def test_nothing_but_to_meshio_needs_meshio(runs, monkeypatch):
    monkeypatch.setitem(sys.modules, "meshio", None)
    with pytest.raises(ImportError, match="python3-meshio"):
        runs["newton"][0].to_meshio()
