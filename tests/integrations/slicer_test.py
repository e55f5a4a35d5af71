"""The module for 3D Slicer against a stand-in of it: frames, transforms, what is missing, and real solves."""
import json
import pathlib
import sys
import unittest

import numpy as np
import pytest

import coapt
import slicer_stand_in

slicer = slicer_stand_in.install()
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "integrations/slicer/CoaptValve"))
import CoaptValve  # noqa: E402
from CoaptValveLib import valve_nodes  # noqa: E402

TRIANGLES = 300
LPS_OF_RAS = np.array([-1, -1, 1])


@pytest.fixture(autouse=True)
def empty_scene():
    slicer.mrmlScene.Clear()
    slicer.shown.clear()
    slicer.drawn.clear()


@pytest.fixture(name="nodes")
def generated():
    return CoaptValve.CoaptValveLogic().generate(TRIANGLES)


def values(attributes, name):
    return attributes.GetArray(name).values


@pytest.fixture(scope="module", name="direct")
def solved_from_files(tmp_path_factory):
    """The same valve from files in LPS, without Slicer."""
    folder = tmp_path_factory.mktemp("direct")
    scene = coapt.generate_mitral(folder / "valve", triangles=TRIANGLES)
    valve = json.loads((scene.parent / "valve.json").read_text())
    for name, kind in (("annulus_closed", "ClosedCurve"), ("papillary", "Fiducial"), ("papillary_closed", "Fiducial")):
        points = np.array(valve[name])
        if kind == "ClosedCurve":  # as the stand-in divides it
            curve = slicer_stand_in.ClosedCurveNode("")
            curve.positions = points
            points = curve.curve()[:-1]
        (folder / f"{name}.mrk.json").write_text(json.dumps({"markups": [{
            "type": kind, "coordinateSystem": "LPS", "controlPoints": [{"position": p} for p in points.tolist()]}]}))
    imported = coapt.import_valve(
        scene.parent / "leaflets.obj", folder / "scene", pressure="120 mmHg",
        **{name: folder / f"{name}.mrk.json" for name in ("annulus_closed", "papillary", "papillary_closed")})
    result = coapt.solve(imported.scene)
    assert result.success
    return result


def test_the_test_of_the_module_passes():
    done = unittest.TestResult()
    CoaptValve.CoaptValveTest().run(done)
    assert done.testsRun == 1 and done.wasSuccessful(), done.errors + done.failures


def test_the_closed_model_is_that_of_the_files_turned_to_ras(nodes, direct):
    closed = CoaptValve.CoaptValveLogic().close(*nodes)
    np.testing.assert_allclose(closed.result.x, direct.x, atol=1e-6)
    surface = closed.model.GetPolyData()
    np.testing.assert_array_equal(surface.points.GetData().values, closed.result.x * LPS_OF_RAS)
    moved = values(surface.GetPointData(), "displacement")
    assert np.abs(moved[:, :2]).max() > 1
    np.testing.assert_array_equal(moved, closed.result.fields["displacement"] * LPS_OF_RAS)
    np.testing.assert_array_equal(surface.polys.GetData().values.reshape(-1, 4)[:, 1:], closed.result.faces)
    np.testing.assert_array_equal(surface.lines.GetData().values.reshape(-1, 3)[:, 1:], closed.result.lines)
    lines = len(closed.result.lines)
    assert lines > 0
    np.testing.assert_array_equal(values(surface.GetCellData(), "line_force")[:lines], closed.result.fields["line_force"])
    np.testing.assert_array_equal(values(surface.GetCellData(), "cauchy_stress")[lines:], closed.result.fields["cauchy_stress"])
    assert set(closed.result.fields) <= set(surface.point_data.arrays) | set(surface.cell_data.arrays)
    assert closed.model.has_display and closed.model.description == closed.result.message
    assert closed.model.GetName() == "Leaflets, closed" and closed.model in slicer.mrmlScene.nodes


def test_the_table_has_the_figures(nodes):
    closed = CoaptValve.CoaptValveLogic().close(*nodes)
    names, numbers = (column.values for column in closed.table.columns)
    assert [column.GetName() for column in closed.table.columns] == ["figure", "value"]
    figures = dict(zip(names, numbers.tolist()))
    assert figures["residual"] == closed.result.residual < 1e-8
    assert figures["orifice_area_mm2"] == closed.result.metrics["orifice_area_mm2"]
    assert set(figures) - set(closed.result.metrics) == {"residual", "energy_mj", "iterations"}


def test_transforms_of_the_nodes_count(nodes, direct):
    turn, place = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]), np.array([30.0, -20, 50])
    transform = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLTransformNode", "moved")
    transform.matrix[:3, :3], transform.matrix[:3, 3] = turn, place
    for node in nodes:
        node.SetAndObserveTransformNodeID(transform)
    closed = CoaptValve.CoaptValveLogic().close(*nodes)
    expected = (direct.x * LPS_OF_RAS) @ turn.T + place
    np.testing.assert_allclose(closed.model.GetPolyData().points.GetData().values, expected, atol=1e-4)
    assert closed.model.GetParentTransformNode() is None


def test_a_mirror_image_keeps_its_normals_on_their_side(nodes):
    transform = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLTransformNode", "mirror")
    transform.matrix[0, 0] = -1
    _, before = valve_nodes.surface_of(nodes[0])
    nodes[0].SetAndObserveTransformNodeID(transform)
    _, after = valve_nodes.surface_of(nodes[0])
    np.testing.assert_array_equal(after, before[:, ::-1])


def test_what_cannot_be_moved_or_is_no_triangle_is_named(nodes):
    transform = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLTransformNode", "warped")
    transform.matrix = None
    nodes[0].SetAndObserveTransformNodeID(transform)
    with pytest.raises(ValueError, match="harden the transform"):
        CoaptValve.CoaptValveLogic().close(*nodes)
    quad = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLModelNode", "quad")
    quad.SetAndObservePolyData(slicer_stand_in.PolyData())
    quad.surface.polys.SetCells(1, slicer_stand_in.numpy_to_vtkIdTypeArray(np.array([4, 0, 1, 2, 3])))
    with pytest.raises(ValueError, match="triangulate"):
        CoaptValve.CoaptValveLogic().close(quad, *nodes[1:])


def test_points_that_are_not_placed_do_not_count(nodes):
    papillary = nodes[2]
    before = valve_nodes.placed_points(papillary)
    papillary.positions = np.concatenate([papillary.positions, [[0.0, 0, 0]]])
    papillary.status.append(slicer.vtkMRMLMarkupsNode.PositionPreview)
    np.testing.assert_array_equal(valve_nodes.placed_points(papillary), before)


def panel():
    widget = CoaptValve.CoaptValveWidget()
    widget.setup()
    return widget


def test_the_panel_closes_what_it_generated(monkeypatch):
    widget = panel()
    monkeypatch.setattr(widget.logic, "generate", lambda: CoaptValve.CoaptValveLogic().generate(TRIANGLES))
    widget.buttons["generate"].click()
    assert not widget.buttons["cancel"].enabled
    widget.texts["pressure"].text = "80 mmHg"
    widget.buttons["close"].click()
    assert slicer.shown == [] and len(slicer.drawn) > 2 and widget.status.text.startswith("converged")
    assert widget.buttons["close"].enabled and not widget.buttons["cancel"].enabled
    assert [node.GetName() for node in slicer.mrmlScene.nodes[4:]] == ["Leaflets, closed", "Leaflets, figures"]


def test_a_run_that_is_cancelled_says_so_and_keeps_its_shape(monkeypatch):
    widget = panel()
    monkeypatch.setattr(widget.logic, "generate", lambda: CoaptValve.CoaptValveLogic().generate(TRIANGLES))
    widget.buttons["generate"].click()
    monkeypatch.setattr(slicer.app, "processEvents", widget.buttons["cancel"].click)
    widget.buttons["close"].click()
    [(kind, text)] = slicer.shown
    assert kind == "warning" and "did not close" in text and len(slicer.mrmlScene.nodes) == 6


def test_all_that_is_missing_stands_in_one_box(nodes):
    widget = panel()
    widget.buttons["close"].click()
    [(kind, text)] = slicer.shown
    assert kind == "error" and text.count("\n") == 2
    assert all(f"{name}: choose" in text for name in ("Leaflets", "Annulus", "Papillary points"))
    nodes[1].positions, nodes[3].positions = nodes[1].positions[:2], nodes[3].positions[:1]
    nodes[1].status, nodes[3].status = nodes[1].status[:2], nodes[3].status[:1]
    problems = CoaptValve.CoaptValveLogic().missing(*nodes)
    assert len(problems) == 2 and "fewer than three points" in problems[0] and "as many" in problems[1]


def test_what_coapt_refuses_is_shown_without_names_of_temporary_files(nodes):
    widget = panel()
    for selector, node in zip(widget.nodes.values(), nodes):
        selector.setCurrentNode(node)
    widget.texts["pressure"].text = "120 furlongs"
    widget.buttons["close"].click()
    nodes[0].GetPolyData().points.GetData().values *= 0.001
    widget.texts["pressure"].text = "120 mmHg"
    widget.buttons["close"].click()
    (first, pressure), (second, size) = slicer.shown
    assert first == second == "error" and "furlongs" in pressure and "unit" in size and "/coapt-" not in pressure + size
    assert widget.buttons["close"].enabled and len(slicer.mrmlScene.nodes) == 4


def test_normals_are_turned_round_where_that_is_asked(nodes, direct):
    cells = nodes[0].GetPolyData().polys.GetData().values.reshape(-1, 4)
    cells[:, 1:] = cells[:, :0:-1].copy()
    closed = CoaptValve.CoaptValveLogic().close(*nodes, flips_normals=True)
    np.testing.assert_allclose(closed.result.x, direct.x, atol=1e-6)


def test_without_the_module_coapt_the_box_says_how_to_install_it(nodes, monkeypatch):
    monkeypatch.setitem(sys.modules, "coapt", None)
    with pytest.raises(RuntimeError, match="pip_install"):
        CoaptValve.CoaptValveLogic().close(*nodes)
    panel().buttons["generate"].click()
    assert slicer.shown[0][0] == "error" and "pip_install" in slicer.shown[0][1]
