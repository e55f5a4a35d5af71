"""Module of 3D Slicer: closes a valve of the scene with Coapt (docs/slicer.md)."""
import pathlib
import tempfile
from typing import Any, NamedTuple

import ctk
import qt
import slicer
from CoaptValveLib import valve_nodes
from slicer.ScriptedLoadableModule import (ScriptedLoadableModule, ScriptedLoadableModuleLogic, ScriptedLoadableModuleTest,
                                           ScriptedLoadableModuleWidget)


class CoaptValve(ScriptedLoadableModule):
    def __init__(self, parent):
        ScriptedLoadableModule.__init__(self, parent)
        self.parent.title = "Coapt: close a valve"
        self.parent.categories = ["Cardiac"]
        self.parent.dependencies = []
        self.parent.contributors = ["The authors of Coapt"]
        self.parent.helpText = ("Takes leaflets, the annulus of the closed valve and papillary points, finds the closed, loaded "
                                "equilibrium, and adds it as a model with its fields and a table of figures.")
        self.parent.acknowledgementText = ""


class Closed(NamedTuple):
    """A closed valve in the scene."""
    model: Any  #: vtkMRMLModelNode, the closed shape with its fields, in world RAS
    table: Any  #: vtkMRMLTableNode, figures
    result: Any  #: coapt.Result, in LPS
    warnings: list  #: whole sentences, of import and solve


def coapt_module():
    """The Python module coapt. Raises RuntimeError that says how to install it."""
    try:
        import coapt
    except ImportError as error:
        raise RuntimeError("The Python module coapt cannot be imported by Slicer's Python. Install its wheel in the Python "
                           f'console, slicer.util.pip_install("/path/to/coapt-....whl"), and try again. ({error})') from error
    return coapt


class CoaptValveLogic(ScriptedLoadableModuleLogic):
    """What the module does, without its panel."""

    def missing(self, leaflets, annulus, papillary, papillary_closed=None):
        """What the nodes lack, whole sentences; empty: nothing."""
        problems = []
        if leaflets is None or leaflets.GetPolyData() is None or leaflets.GetPolyData().GetNumberOfPolys() == 0:
            problems.append("Leaflets: choose a model with triangles, the open valve.")
        if annulus is None:
            problems.append("Annulus: choose a closed curve, drawn along the annulus of the closed valve.")
        elif len(valve_nodes.placed_points(annulus)) < 3:
            problems.append(f"Annulus: the curve \"{annulus.GetName()}\" has fewer than three points; draw it all around.")
        tips = 0 if papillary is None else len(valve_nodes.placed_points(papillary))
        if tips == 0:
            problems.append("Papillary points: choose a point list with at least one point, where chords begin.")
        if papillary_closed is not None and len(valve_nodes.placed_points(papillary_closed)) != tips:
            problems.append("Papillary points of the closed valve: as many are needed as of the open one, in the same order.")
        return problems

    def close(self, leaflets, annulus, papillary, papillary_closed=None, *, pressure="120 mmHg", young="", chord_young="",
              flips_normals=False, callback=None):
        """Closes the valve and adds the closed shape and a table to the scene; the nodes that are given stay as they are.

        Args:
            leaflets: model node of the open valve, one layer of triangles whose normals point to the side of the pressure.
            annulus: closed curve node; the rim of the leaflets nearest to it moves onto it.
            papillary, papillary_closed: point list nodes; straight chords tie the first to the free edge, the second says
                where they go (None: they stay).
            pressure, young, chord_young: quantities with units; empty moduli stand for Coapt's own (1 MPa, 40 MPa).
            flips_normals: whether the triangles are turned round.
            callback: as of `coapt.solve`; returning False ends the run, which keeps its last iterate.

        Returns:
            A `Closed`; `result.success` says whether it converged.

        Raises:
            ValueError: nodes are missing or cannot be used; it has all that was found.
            RuntimeError: the module coapt is not installed.
        """
        problems = self.missing(leaflets, annulus, papillary, papillary_closed)
        if problems:
            raise ValueError("\n".join(problems))
        coapt = coapt_module()
        points, triangles = valve_nodes.surface_of(leaflets)
        with tempfile.TemporaryDirectory(prefix="coapt-") as folder:
            given = pathlib.Path(folder) / "given"
            given.mkdir()
            valve_nodes.write_surface(given / "leaflets.obj", points, triangles[:, ::-1] if flips_normals else triangles)
            curves = {"annulus_closed": ("ClosedCurve", valve_nodes.curve_points(annulus)),
                      "papillary": ("Fiducial", valve_nodes.placed_points(papillary))}
            if papillary_closed is not None:
                curves["papillary_closed"] = "Fiducial", valve_nodes.placed_points(papillary_closed)
            for name, (kind, places) in curves.items():
                valve_nodes.write_markups(given / f"{name}.mrk.json", kind, places)
            try:
                scene, warnings = coapt.import_valve(given / "leaflets.obj", pathlib.Path(folder) / "valve",
                                                     **{name: given / f"{name}.mrk.json" for name in curves},
                                                     pressure=pressure, young=young or None, chord_young=chord_young or None)
                result = coapt.solve(scene, callback=callback)
            except coapt.InputError as error:  # nobody knows the files that it names
                raise ValueError(str(error).replace(f"{given}/", "").replace(f"{folder}/", "")) from error
            said = [text.replace(f"{given}/", "").replace(f"{folder}/", "") for text in [*warnings, *result.warnings]]
        name = leaflets.GetName()
        return Closed(valve_nodes.closed_node(result, f"{name}, closed"), valve_nodes.table_node(result, f"{name}, figures"),
                      result, list(dict.fromkeys(said)))

    def generate(self, triangles=1000):
        """Adds a generated mitral valve, to try things on: leaflets, annulus, papillary points open and closed."""
        coapt = coapt_module()
        with tempfile.TemporaryDirectory(prefix="coapt-") as folder:
            return valve_nodes.generated_nodes(coapt, folder, triangles)


class CoaptValveWidget(ScriptedLoadableModuleWidget):
    """The panel: what the valve is, a button that closes it and one that cancels, and what came out."""

    def setup(self):
        ScriptedLoadableModuleWidget.setup(self)
        self.logic = CoaptValveLogic()
        self.is_cancelled = False
        section = ctk.ctkCollapsibleButton()
        section.text = "Valve"
        self.layout.addWidget(section)
        form = qt.QFormLayout(section)
        self.nodes = {}
        for key, label, kind, tip in (
                ("leaflets", "Leaflets", "vtkMRMLModelNode", "The open valve: one layer of triangles"),
                ("annulus", "Annulus, closed", "vtkMRMLMarkupsClosedCurveNode", "Along the annulus of the closed valve"),
                ("papillary", "Papillary points", "vtkMRMLMarkupsFiducialNode", "Where the chords begin"),
                ("papillary_closed", "Papillary points, closed", "vtkMRMLMarkupsFiducialNode",
                 "Where they are in the closed valve; none: they stay")):
            selector = slicer.qMRMLNodeComboBox()
            selector.nodeTypes = [kind]
            selector.noneEnabled, selector.addEnabled, selector.removeEnabled = True, False, False
            selector.toolTip = tip
            selector.setMRMLScene(slicer.mrmlScene)
            form.addRow(label, selector)
            self.nodes[key] = selector
        self.texts = {}
        for key, label, text in (("pressure", "Pressure", "120 mmHg"), ("young", "Young's modulus of leaflets", "1 MPa"),
                                 ("chord_young", "Young's modulus of chords", "40 MPa")):
            self.texts[key] = qt.QLineEdit(text)
            form.addRow(label, self.texts[key])
        self.flip = qt.QCheckBox("Turn normals round")
        self.flip.toolTip = "The pressure acts on the side that the normals of the leaflets point to"
        form.addRow("", self.flip)
        self.setup_buttons(form)

    def setup_buttons(self, form):
        self.buttons = {}
        for key, label, action in (("generate", "Add a generated valve", self.on_generate),
                                   ("close", "Close the valve", self.on_close), ("cancel", "Cancel", self.on_cancel)):
            self.buttons[key] = qt.QPushButton(label)
            self.buttons[key].connect("clicked(bool)", action)
            form.addRow(self.buttons[key])
        self.buttons["cancel"].enabled = False
        self.status = qt.QLabel("")
        self.status.wordWrap = True
        form.addRow(self.status)
        self.layout.addStretch(1)

    def on_generate(self, _=False):
        try:
            nodes = self.logic.generate()
        except (RuntimeError, ValueError) as error:
            slicer.util.errorDisplay(str(error), windowTitle="Coapt")
            return
        for selector, node in zip(self.nodes.values(), nodes):
            selector.setCurrentNode(node)

    def on_cancel(self, _=False):
        self.is_cancelled = True

    def on_iterate(self, at):
        """Shows an iterate and lets Slicer draw and take clicks; False once the run is cancelled."""
        self.status.text = f"iteration {at.iteration}, residual {at.residual:.2e}"
        slicer.app.processEvents()
        return not self.is_cancelled

    def on_close(self, _=False):
        self.is_cancelled = False
        self.set_running(True)
        try:
            closed = self.logic.close(**{key: selector.currentNode() for key, selector in self.nodes.items()},
                                      **{key: edit.text.strip() for key, edit in self.texts.items()},
                                      flips_normals=self.flip.checked, callback=self.on_iterate)
        except (RuntimeError, ValueError) as error:
            self.status.text = ""
            slicer.util.errorDisplay(str(error), windowTitle="Coapt")
            return
        finally:
            self.set_running(False)
        self.status.text = "\n".join([closed.result.message, *closed.warnings])
        if not closed.result.success:
            slicer.util.warningDisplay(f"The valve did not close to an equilibrium: {closed.result.message}", windowTitle="Coapt")

    def set_running(self, is_running):
        for key, button in self.buttons.items():
            button.enabled = is_running == (key == "cancel")


class CoaptValveTest(ScriptedLoadableModuleTest):
    """Run by Slicer (Reload and Test), and by Coapt's own tests against a stand-in of Slicer."""

    def setUp(self):
        slicer.mrmlScene.Clear()

    def runTest(self):
        self.setUp()
        self.test_closes_a_generated_valve()

    def test_closes_a_generated_valve(self):
        logic = CoaptValveLogic()
        closed = logic.close(*logic.generate(triangles=300))
        self.assertTrue(closed.result.success, closed.result.message)
        surface = closed.model.GetPolyData()
        self.assertEqual(surface.GetNumberOfPolys(), len(closed.result.faces))
        self.assertIsNotNone(surface.GetPointData().GetArray("displacement"))
        self.assertIsNotNone(surface.GetCellData().GetArray("cauchy_stress"))
        self.assertGreater(closed.result.metrics["annulus_area_mm2"], 5 * closed.result.metrics["orifice_area_mm2"])
