"""A stand-in for 3D Slicer: as much of its modules slicer, vtk, qt and ctk as CoaptValve uses, written from their
documentation and stricter than they are. A name that is not here is an AttributeError."""
import sys
import types
import unittest

import numpy as np


class Named:
    def __init__(self, name=""):
        self._name = name

    def SetName(self, name):
        self._name = name

    def GetName(self):
        return self._name


# vtk

class Array(Named):
    """vtkDataArray."""

    def __init__(self, values):
        super().__init__()
        self.values = values

    def GetNumberOfTuples(self):
        return len(self.values)


class StringArray(Named):
    def __init__(self):
        super().__init__()
        self.values = []

    def InsertNextValue(self, text):
        assert isinstance(text, str)
        self.values.append(text)

    def GetNumberOfTuples(self):
        return len(self.values)


def numpy_to_vtk(values, deep=False):
    assert values.flags.c_contiguous and values.ndim in (1, 2) and values.dtype.kind in "fiu", (values.dtype, values.shape)
    return Array(values.copy() if deep else values)


def numpy_to_vtkIdTypeArray(values, deep=False):
    assert values.dtype == np.int64 and values.ndim == 1
    return numpy_to_vtk(values, deep)


class PointsOfVtk:
    def SetData(self, array):
        assert array.values.shape[1] == 3
        self.data = array

    def GetData(self):
        return self.data


class CellArray:
    def __init__(self):
        self.count, self.data = 0, Array(np.zeros(0, dtype=np.int64))

    def SetCells(self, count, array):
        place = 0
        for _ in range(count):
            place += 1 + array.values[place]
        assert place == len(array.values)
        self.count, self.data = count, array

    def GetNumberOfCells(self):
        return self.count

    def GetData(self):
        return self.data


class Attributes:
    def __init__(self, count):
        self.count, self.arrays = count, {}

    def AddArray(self, array):
        assert array.GetNumberOfTuples() == self.count() and array.GetName() and array.GetName() not in self.arrays
        self.arrays[array.GetName()] = array

    def GetArray(self, name):
        return self.arrays.get(name)


class PolyData:
    def __init__(self):
        self.points, self.polys, self.lines = None, CellArray(), CellArray()
        self.point_data = Attributes(lambda: self.points.GetData().GetNumberOfTuples())
        self.cell_data = Attributes(lambda: self.lines.count + self.polys.count)

    def SetPoints(self, points):
        self.points = points

    def SetPolys(self, cells):
        self.polys = cells

    def SetLines(self, cells):
        self.lines = cells

    def GetPolys(self):
        return self.polys

    def GetLines(self):
        return self.lines

    def GetNumberOfPolys(self):
        return self.polys.count

    def GetPointData(self):
        return self.point_data

    def GetCellData(self):
        return self.cell_data


# MRML

class Node(Named):
    def __init__(self, name):
        super().__init__(name)
        self.description, self.transform = "", None

    def SetDescription(self, text):
        self.description = text

    def SetAndObserveTransformNodeID(self, transform):  # of Slicer the ID; here the node itself
        self.transform = transform

    def GetParentTransformNode(self):
        return self.transform


class TransformNode(Node):
    """`matrix` (4, 4) to the world; None: not linear."""

    def __init__(self, name):
        super().__init__(name)
        self.matrix = np.eye(4)


class ModelNode(Node):
    def __init__(self, name):
        super().__init__(name)
        self.surface, self.has_display = None, False

    def SetAndObservePolyData(self, surface):
        self.surface = surface

    def GetPolyData(self):
        return self.surface

    def CreateDefaultDisplayNodes(self):
        self.has_display = True


class MarkupsNode(Node):
    PositionUndefined, PositionPreview, PositionDefined = 0, 1, 2

    def __init__(self, name):
        super().__init__(name)
        self.positions, self.status = np.zeros((0, 3)), []

    def GetNumberOfControlPoints(self):
        return len(self.positions)

    def GetNthControlPointPositionStatus(self, k):
        return self.status[k]


class FiducialNode(MarkupsNode):
    pass


class ClosedCurveNode(MarkupsNode):
    """A polygon, each side in eight; the last point is the first again."""

    def curve(self):
        ends = np.roll(self.positions, -1, axis=0)
        parts = np.arange(8)[None, :, None] / 8
        points = (self.positions[:, None] * (1 - parts) + ends[:, None] * parts).reshape(-1, 3)
        return np.concatenate([points, points[:1]])


class TableNode(Node):
    def __init__(self, name):
        super().__init__(name)
        self.columns = []

    def SetUseColumnNameAsColumnHeader(self, use):
        self.uses_names = use

    def AddColumn(self, array):
        assert not self.columns or array.GetNumberOfTuples() == self.columns[0].GetNumberOfTuples()
        self.columns.append(array)


class Scene:
    KINDS = {"vtkMRMLModelNode": ModelNode, "vtkMRMLMarkupsClosedCurveNode": ClosedCurveNode, "vtkMRMLTableNode": TableNode,
             "vtkMRMLMarkupsFiducialNode": FiducialNode, "vtkMRMLTransformNode": TransformNode}

    def __init__(self):
        self.nodes = []

    def AddNewNodeByClass(self, kind, name):
        self.nodes.append(self.KINDS[kind](name))
        return self.nodes[-1]

    def Clear(self):
        self.nodes.clear()


# slicer.util

def _in_world(node, points):
    if node.transform is None:
        return points.copy()
    return points @ node.transform.matrix[:3, :3].T + node.transform.matrix[:3, 3]


def transform_matrix(node, toWorld=False):
    assert toWorld
    if node.matrix is None:
        raise RuntimeError("Failed to get transformation matrix from node")
    return node.matrix.copy()


def update_control_points(node, positions, world=False):
    assert world and node.transform is None
    node.positions, node.status = positions.copy(), [MarkupsNode.PositionDefined] * len(positions)


# Qt

class Widget:
    def __init__(self, parent=None):
        self.toolTip, self.enabled = "", True


class Text(Widget):
    def __init__(self, text):
        super().__init__()
        self.text, self.wordWrap, self.checked = text, False, False


class Button(Text):
    def connect(self, signal, action):
        assert signal == "clicked(bool)"
        self.action = action

    def click(self):
        assert self.enabled
        self.action(False)


class Layout(Widget):
    def addRow(self, *widgets):
        assert len(widgets) in (1, 2)

    def addWidget(self, widget):
        assert isinstance(widget, Widget)

    def addStretch(self, stretch):
        pass


class NodeSelector(Widget):
    node = None

    def setMRMLScene(self, scene):
        self.scene = scene

    def currentNode(self):
        return self.node

    def setCurrentNode(self, node):
        assert any(isinstance(node, self.scene.KINDS[kind]) for kind in self.nodeTypes)
        self.node = node


# The modules

class Module:
    def __init__(self, parent):
        self.parent = parent


class ModuleWidget:
    def setup(self):
        self.layout = Layout()


class Test(unittest.TestCase):
    def runTest(self):
        raise NotImplementedError


def _module(name, **content):
    module = sys.modules[name] = types.ModuleType(name)
    vars(module).update(content)
    return module


def install():
    """Puts the modules where `import` finds them; returns slicer, with `shown`, the message boxes, and `drawn`, how
    often Slicer got to draw."""
    numpy_support = _module("vtk.util.numpy_support", numpy_to_vtk=numpy_to_vtk, numpy_to_vtkIdTypeArray=numpy_to_vtkIdTypeArray)
    _module("vtk", vtkPoints=PointsOfVtk, vtkCellArray=CellArray, vtkPolyData=PolyData, vtkStringArray=StringArray,
            util=_module("vtk.util", numpy_support=numpy_support))
    _module("qt", QFormLayout=Layout, QLineEdit=Text, QCheckBox=Text, QLabel=Text, QPushButton=Button)
    _module("ctk", ctkCollapsibleButton=Widget)
    scripted = _module("slicer.ScriptedLoadableModule", ScriptedLoadableModule=Module, ScriptedLoadableModuleWidget=ModuleWidget,
                       ScriptedLoadableModuleLogic=object, ScriptedLoadableModuleTest=Test)
    slicer = _module("slicer", ScriptedLoadableModule=scripted, mrmlScene=Scene(), qMRMLNodeComboBox=NodeSelector,
                     vtkMRMLMarkupsNode=MarkupsNode, shown=[], drawn=[])
    slicer.app = types.SimpleNamespace(processEvents=lambda: slicer.drawn.append(True))
    slicer.util = _module(
        "slicer.util", arrayFromModelPoints=lambda node: node.surface.points.GetData().values,
        arrayFromModelPolyIds=lambda node: node.surface.polys.GetData().values, arrayFromTransformMatrix=transform_matrix,
        arrayFromMarkupsControlPoints=lambda node, world=False: _in_world(node, node.positions),
        arrayFromMarkupsCurvePoints=lambda node, world=False: _in_world(node, node.curve()),
        updateMarkupsControlPointsFromArray=update_control_points,
        errorDisplay=lambda text, windowTitle: slicer.shown.append(("error", text)),
        warningDisplay=lambda text, windowTitle: slicer.shown.append(("warning", text)))
    return slicer
