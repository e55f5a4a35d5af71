"""Nodes of 3D Slicer as what Coapt takes, and its results as nodes.

Nodes stand in RAS, Coapt in LPS: x and y change their sign both ways, which is half a turn and mirrors nothing. Lengths are
mm, arrays of points have shape (n, 3).
"""
import json
import pathlib

import numpy as np
import slicer
import vtk
from vtk.util import numpy_support


def turned(vectors):
    """RAS as LPS, or LPS as RAS, (n, 3)."""
    return vectors * np.array([-1.0, -1.0, 1.0])


def surface_of(model):
    """Vertices (n, 3) in world RAS [mm] and triangles (m, 3) of a model node. Raises ValueError."""
    cells = np.array(slicer.util.arrayFromModelPolyIds(model))
    if cells.size % 4 or (cells[::4] != 3).any():
        raise ValueError("Leaflets: the model has polygons of more than three corners; triangulate it (module Surface Toolbox).")
    points = np.array(slicer.util.arrayFromModelPoints(model), dtype=float)
    triangles = cells.reshape(-1, 4)[:, 1:]
    transform = model.GetParentTransformNode()
    if transform is not None:
        try:
            matrix = slicer.util.arrayFromTransformMatrix(transform, toWorld=True)
        except RuntimeError:
            raise ValueError("Leaflets: the model is under a transform that is not linear; harden the transform.") from None
        points = points @ matrix[:3, :3].T + matrix[:3, 3]
        if np.linalg.det(matrix[:3, :3]) < 0:  # a mirror image keeps its normals outside
            triangles = triangles[:, ::-1]
    return points, triangles


def placed_points(markups):
    """Control points that are placed, (n, 3) in world RAS [mm]."""
    placed = [k for k in range(markups.GetNumberOfControlPoints())
              if markups.GetNthControlPointPositionStatus(k) == slicer.vtkMRMLMarkupsNode.PositionDefined]
    return np.array(slicer.util.arrayFromMarkupsControlPoints(markups, world=True), dtype=float).reshape(-1, 3)[placed]


def curve_points(curve):
    """The closed curve as it is drawn, (n, 3) in world RAS [mm], no point twice in a row."""
    points = np.array(slicer.util.arrayFromMarkupsCurvePoints(curve, world=True), dtype=float)
    return points[np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1) > 0]


def write_surface(path, points, triangles):
    """Writes an OBJ file of RAS points in LPS."""
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in turned(points).tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (triangles + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")


def write_markups(path, kind, points):
    """Writes RAS points as a markups file in LPS; kind: "ClosedCurve" or "Fiducial"."""
    controls = [{"label": str(k + 1), "position": position, "positionStatus": "defined"}
                for k, position in enumerate(turned(points).tolist())]
    path.write_text(json.dumps({"markups": [{"type": kind, "coordinateSystem": "LPS", "coordinateUnits": "mm",
                                             "controlPoints": controls}]}))


def _named(values, name):
    array = numpy_support.numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    return array


def _cells(corners):
    counted = np.insert(np.asarray(corners, dtype=np.int64), 0, corners.shape[1], axis=1)
    cells = vtk.vtkCellArray()
    cells.SetCells(len(corners), numpy_support.numpy_to_vtkIdTypeArray(counted.ravel(), deep=True))
    return cells


def surface_node(name, points, triangles, lines=None):
    """A new model node of RAS points (n, 3), triangles (m, 3) and lines (k, 2)."""
    places = vtk.vtkPoints()
    places.SetData(numpy_support.numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    surface = vtk.vtkPolyData()
    surface.SetPoints(places)
    surface.SetPolys(_cells(triangles))
    if lines is not None and len(lines):
        surface.SetLines(_cells(lines))
    node = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLModelNode", name)
    node.SetAndObservePolyData(surface)
    node.CreateDefaultDisplayNodes()
    return node


def closed_node(result, name):
    """A new model node of the closed shape, with all fields as point and cell data; vectors are turned to RAS as the
    positions are. VTK counts the cells of a surface lines first."""
    node = surface_node(name, turned(result.x), result.faces, result.lines)
    node.SetDescription(result.message)
    surface, fields = node.GetPolyData(), result.field_arrays()
    for field, values in fields.of_nodes.items():
        surface.GetPointData().AddArray(_named(turned(values) if values.shape[1:] == (3,) else values, field))
    for field, (of_triangles, of_lines) in fields.of_cells.items():
        surface.GetCellData().AddArray(_named(np.concatenate([of_lines, of_triangles]), field))
    surface.GetPointData().AddArray(_named(result.undetermined, "undetermined"))
    return node


def figures_of(result):
    """Names, as in docs/metrics.md with their units, and numbers."""
    run = {"residual": result.residual, "energy_mj": result.fun, "iterations": result.nit}
    return {name: float(value) for name, value in {**run, **result.metrics}.items() if value is not None}


def table_node(result, name):
    """A new table node with the columns figure and value."""
    figures = figures_of(result)
    names = vtk.vtkStringArray()
    names.SetName("figure")
    for figure in figures:
        names.InsertNextValue(figure)
    node = slicer.mrmlScene.AddNewNodeByClass("vtkMRMLTableNode", name)
    node.SetUseColumnNameAsColumnHeader(True)
    node.AddColumn(names)
    node.AddColumn(_named(np.array(list(figures.values())), "value"))
    node.SetDescription(result.message)
    return node


def _markups_node(kind, name, points):
    node = slicer.mrmlScene.AddNewNodeByClass(kind, name)
    slicer.util.updateMarkupsControlPointsFromArray(node, turned(np.array(points, dtype=float)), world=True)
    return node


def generated_nodes(coapt, folder, triangles):
    """The generated mitral valve as nodes: leaflets, closed annulus, papillary points and where they go."""
    valve = json.loads((coapt.generate_mitral(folder, triangles=triangles).parent / "valve.json").read_text())
    lines = [line.split() for line in (pathlib.Path(folder) / "leaflets.obj").read_text().splitlines()]
    points = np.array([line[1:] for line in lines if line[:1] == ["v"]], dtype=float)
    corners = np.array([line[1:] for line in lines if line[:1] == ["f"]], dtype=int) - 1
    return (surface_node("Leaflets", turned(points), corners),
            _markups_node("vtkMRMLMarkupsClosedCurveNode", "Annulus", valve["annulus_closed"]),
            _markups_node("vtkMRMLMarkupsFiducialNode", "Papillary points", valve["papillary"]),
            _markups_node("vtkMRMLMarkupsFiducialNode", "Papillary points, closed", valve["papillary_closed"]))
