"""Drives the real command as a user does: exit codes, messages, files.

Usage: command_test.py COAPT_BINARY RESULT_SCHEMA [unittest arguments]
"""
import csv
import json
import os
import pathlib
import re
import stat
import subprocess
import sys
import unittest
from xml.etree import ElementTree

from command_case import COAPT, FILES, CommandCase, coapt, content_of

try:
    import jsonschema
except ImportError:
    jsonschema = None

SCHEMA = pathlib.Path(sys.argv[2])
VALVE_FILES = {"coaptation_line.vtp", "orifice.vtp"}


class CommandTest(CommandCase):
    def test_solves_every_generated_shape(self):
        for shape in ["disc", "square", "sphere", "tent", "catenary", "airbag", "strip", "mitral"]:
            with self.subTest(shape):
                scene = self.generate(shape, *([] if shape == "catenary" else ["--triangles", 400]))
                run = coapt("solve", scene)
                self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
                self.assertEqual(run.stderr, "", "quiet in a pipe")
                self.assertIn("residual", run.stdout)
                result = self.result()
                written = {p.name for p in (self.folder / "result").iterdir()}
                self.assertEqual(written, set(result["files"]))
                without_surface = {"closed.obj"} if result["mesh"]["triangles"] == 0 else set()
                self.assertEqual(written - VALVE_FILES, FILES - without_surface)
                self.assertEqual(bool(written & VALVE_FILES), shape == "mitral")
                self.assertTrue(result["converged"])
                self.assertLessEqual(result["residual"], 1e-6)
                self.assertLess(result["metrics"]["force_balance"], 1e-5)

    def test_an_airbag_takes_as_many_iterations_on_a_checkerboard(self):
        scene = self.generate("airbag", "--triangles", 900)
        counts, heights = [], []
        for _ in range(2):
            self.assertEqual(coapt("solve", scene, "--no-report").returncode, 0)
            counts.append(self.result()["iterations"])
            heights.append(self.result()["metrics"]["max_displacement_mm"])
            cells, side = 21, 600 / 2 ** 0.5
            number = lambda i, j: i * (cells + 1) + j + 1
            with (self.folder / "mesh.obj").open("w") as mesh:
                for i in range(cells + 1):
                    mesh.writelines(f"v {side * i / cells:.12g} {side * j / cells:.12g} 0\n" for j in range(cells + 1))
                for i in range(cells):
                    for j in range(cells):
                        a, b, c, d = number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)
                        halves = [(a, b, c), (a, c, d)] if (i + j) % 2 == 0 else [(a, b, d), (b, c, d)]
                        mesh.writelines(f"f {p} {q} {r}\n" for p, q, r in halves)
        self.assertLess(max(counts), 45)  # 142 and more where the sheet bears compression
        self.assertLess(max(counts), 1.3 * min(counts))
        self.assertAlmostEqual(heights[0], heights[1], delta=2)
        self.assertAlmostEqual(heights[0], 216.3, delta=2)

    def test_writes_a_page_unless_nobody_wants_it(self):
        scene = self.generate("disc", "--triangles", 200)
        page = self.folder / "result" / "report.html"
        self.assertIn("report.html", coapt("solve", scene).stdout)
        text = page.read_text()
        self.assertTrue(text.startswith("<!DOCTYPE html>") and text.endswith("</html>\n"))
        self.assertIn(self.result()["message"], text)
        self.assertNotIn("http://", text.split("<script")[0])
        coapt("solve", scene, "--no-report")
        self.assertFalse(page.exists(), "one of an earlier solve would be taken for this one's")
        self.assertNotIn("report.html", self.result()["files"])
        text = scene.read_text()
        scene.write_text(text.replace('"solver":', '"output": { "report": false }, "solver":'))
        self.assertNotEqual(scene.read_text(), text)
        self.assertEqual(coapt("solve", scene).returncode, 0)
        self.assertFalse(page.exists())

    def test_generated_disc_has_the_known_deflection(self):
        scene = self.generate("disc", "--triangles", 2000)
        self.assertEqual(coapt("solve", scene).returncode, 0)
        self.assertAlmostEqual(self.result()["metrics"]["max_displacement_mm"], 1.4138457, delta=0.004)

    def test_results_obey_the_published_schema(self):
        schema = json.loads(SCHEMA.read_text())
        self.assertEqual(coapt("schema", "result").stdout, SCHEMA.read_text())
        if jsonschema is None:
            self.skipTest("skipped: python3-jsonschema not found")
        jsonschema.Draft202012Validator.check_schema(schema)
        validator = jsonschema.Draft202012Validator(schema)
        for shape in ["mitral", "catenary", "disc"]:
            scene = self.generate(shape, *([] if shape == "catenary" else ["--triangles", 300]))
            coapt("solve", scene)
            self.assertEqual([e.message for e in validator.iter_errors(self.result())], [])
        broken = self.result()
        broken["status"] = "fine"
        self.assertNotEqual(list(validator.iter_errors(broken)), [])

    def test_refuses_two_ways_to_raise_the_loads(self):
        scene = self.generate("disc", "--triangles", 100)
        scene.write_text(scene.read_text().replace('"solver": {', '"solver": { "continuation": { "load_steps": 2 },'))
        self.assert_bad_input(coapt("solve", scene, "--damped-steps", 5), "--damped-steps", "load_steps", "scene.json")
        self.assertEqual(coapt("solve", scene, "--no-report", "--damped-steps", 0).returncode, 0)

    def test_looks_for_other_equilibria(self):
        scene = self.generate("mitral", "--triangles", 300)
        self.assertEqual(coapt("solve", scene, "--no-report").returncode, 0)
        self.assertNotIn("branches", self.result())
        run = coapt("solve", scene, "--no-report", "--branches", 2, "--branch-seed", 5)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        result = self.result()
        branches = result["branches"]
        self.assertIn(branches["message"], run.stdout)
        self.assertEqual((branches["starts"], branches["starts_along_path"]), (4, 2))
        self.assertEqual(sum(e["found"] for e in branches["equilibria"]) + branches["not_converged"], 4)
        self.assertEqual(branches["equilibria"][0]["energy_mj"], result["energy_mj"])
        self.assertEqual(branches["equilibria"][0]["metrics"], result["metrics"])
        self.assertEqual("(other equilibria: " in run.stdout, len(branches["equilibria"]) > 1)
        # A damped path is judged by its steps, a solve at once by its iterations.
        self.assertEqual(result["neighbours"], {"judged": True, "suspected": False, "iterates": 0, "unstable_steps": 0})
        self.assertEqual(coapt("solve", scene, "--no-report", "--damped-steps", 0).returncode, 0)
        direct = self.result()
        self.assertEqual(direct["damped_steps"], 0)
        self.assertGreater(result["damped_steps"], 4)  # 3, 6, 8 and 3 twentieths of the loads at least, then more
        self.assertEqual(direct["neighbours"], {"judged": True, "suspected": False, "iterates": direct["iterations"],
                                                "unstable_steps": 0})
        nodes = result["undetermined_nodes"]
        self.assertEqual(nodes["free"], len(result["certificate"]["free_nodes"]))
        self.assertEqual(nodes["total"], nodes["free"] + nodes["differing"])
        self.assertEqual("undetermined nodes" in run.stdout, nodes["total"] > 0)
        if jsonschema is not None:
            validator = jsonschema.Draft202012Validator(json.loads(SCHEMA.read_text()))
            self.assertEqual([e.message for e in validator.iter_errors(result)], [])
        for wrong in [["--branches", 0], ["--branch-kick", 0.1], ["--branches", 1, "--branch-kick", "-1"]]:
            run = coapt("solve", scene, *wrong)
            self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
            self.assertIn("--branch", run.stderr)

    def test_counters_are_zero_for_what_a_scene_does_not_use(self):
        coapt("solve", self.generate("disc", "--triangles", 200))
        self.assertNotIn("collisions", self.result()["time"]["by_phase"])
        counters = self.result()["counters"]
        for kind in ["cable_elements", "contact_candidates", "contact_searches"]:
            self.assertEqual(counters[kind], 0)
        self.assertEqual(counters["membrane_elements"], self.result()["mesh"]["triangles"])
        coapt("solve", self.generate("catenary"))
        self.assertEqual(self.result()["counters"]["pressure_facets"], 0)
        self.assertEqual(self.result()["counters"]["membrane_elements"], 0)
        self.assertEqual(self.result()["counters"]["cable_elements"], 40)

    def square_of(self, terms):
        scene = self.generate("square", "--triangles", 200)
        first, last = scene.read_text().split('"terms": [', 1)
        scene.write_text(first + '"terms": [' + terms + "]" + last.split("]", 1)[1])
        return scene

    def test_counters_tell_films_from_membranes(self):
        scene = self.square_of('{"type": "surface_tension", "tension": "1 N/m"}, {"type": "load_pressure", "value": "1 Pa"}')
        self.assertEqual(coapt("solve", scene).returncode, 0)
        result = self.result()
        self.assertEqual(result["counters"]["membrane_elements"], 0)
        self.assertEqual(result["counters"]["film_elements"], result["mesh"]["triangles"])

    def test_solves_a_sail_of_prescribed_prestress(self):
        sail = ('{"type": "cst_prestress", "name": "sail", "warp": "2 N/m", "weft": "0.5 N/m", "direction": [1, 0, 0],'
                '"thickness": "0.1 mm"}, {"type": "load_field", "direction": [0, 0, 1], "pressure": "1 Pa"}')
        scene = self.square_of(sail)
        self.assertEqual(coapt("check", scene).returncode, 0)
        heights = {}
        for solver in ["newton", "lbfgs"]:
            run = coapt("solve", scene, "--solver", solver, "--tolerance", "1e-8")
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            result = self.result()
            self.assertEqual(result["counters"]["membrane_elements"], result["mesh"]["triangles"])
            closed = (self.folder / "result" / "closed.obj").read_text().splitlines()
            heights[solver] = max(float(line.split()[3]) for line in closed if line.startswith("v "))
        self.assertGreater(heights["newton"], 0)
        self.assertAlmostEqual(heights["lbfgs"] / heights["newton"], 1, places=5)
        fields = re.findall(rb'DataArray [^>]*Name="([^"]+)"', (self.folder / "result" / "closed.vtp").read_bytes())
        self.assertTrue([name for name in fields if b"stress" in name], fields)
        self.assertIn(b"cauchy_stress_1_kpa", fields)
        self.assertNotIn(b"first_piola_stress_1_kpa", fields)
        across = self.square_of(sail.replace("[1, 0, 0]", "[0, 0, 1]"))
        self.assert_bad_input(coapt("solve", across), "direction", "triangle 1, counted from 1")

    def test_frames_of_a_motion_share_one_time(self):
        scene = self.generate("mitral", "--triangles", 200, "--contact", "none")
        scene.write_text(scene.read_text().replace('"boundary":', '"motion": {"steps": 3}, "boundary":', 1))
        run = coapt("solve", scene, "--solver", "dynamic", "--frames", "1", "--tolerance", "1e-4")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        frames = list(ElementTree.parse(self.folder / "result" / "frames.pvd").iter("DataSet"))
        times = [float(frame.get("timestep")) for frame in frames]
        self.assertGreater(len(times), 10)
        self.assertEqual(times, sorted(set(times)))
        with open(self.folder / "result" / "trace.csv") as trace:
            self.assertAlmostEqual(times[-1], float(list(csv.DictReader(trace))[-1]["time_s"]), delta=1e-6 * times[-1])
        for frame in frames:
            self.assertTrue((self.folder / "result" / frame.get("file")).exists())

    def test_a_run_out_of_time_writes_its_result_and_returns_1(self):
        scene = self.generate("mitral", "--triangles", 2500)
        run = coapt("solve", scene, "--max-seconds", "0.05", "--tolerance", "1e-12")
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        self.assertEqual(self.result()["status"], "time_limit")
        self.assertFalse(self.result()["converged"])

    def test_a_state_whose_stability_is_in_doubt_returns_4_and_says_so_first(self):
        scene = self.strips()
        run = coapt("solve", scene, "--solver", "lbfgs", "--tolerance", "0.1")
        self.assertEqual(run.returncode, 4, run.stdout + run.stderr)
        self.assertTrue(run.stdout.startswith("converged, but its stability is in doubt (a saddle of the energy"), run.stdout)
        self.assertTrue(self.result()["converged"])
        self.assertEqual(self.result()["certificate"]["stability"], "saddle")
        run = coapt("solve", scene, "--solver", "lbfgs", "--tolerance", "1e-6")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertTrue(run.stdout.startswith("converged at residual"), run.stdout)
        self.assertEqual(self.result()["certificate"]["stability"], "strict_minimum")

    def test_a_facet_turned_over_is_said_in_the_first_line_and_on_the_page(self):
        scene = self.generate("disc", "--triangles", 200)
        self.assertEqual(coapt("solve", scene).returncode, 0)
        self.assertEqual(self.result()["doubts"], [])
        mesh = self.folder / content_of(scene)["mesh"]["file"]
        lines = mesh.read_text().splitlines()
        face = [k for k, line in enumerate(lines) if line.startswith("f ")][60]
        lines[face] = "f " + " ".join(reversed(lines[face].split()[1:]))
        mesh.write_text("\n".join(lines) + "\n")
        run = coapt("solve", scene)
        said = "; the normal of 1 facet points against the neighbours'"
        self.assertIn(said, run.stdout.splitlines()[0], run.stderr)
        self.assertIn("triangle 61, counted from 1: the normal points", run.stdout)
        self.assertTrue(self.result()["converged"])
        self.assertEqual(self.result()["doubts"], [said[2:]])
        self.assertIn(said[:20], (self.folder / "result" / "report.html").read_text())

    def test_warns_when_most_chords_are_slack(self):
        scene = self.generate("mitral", "--triangles", 400)
        coapt("solve", scene)
        self.assertNotIn("slack", " ".join(self.result()["warnings"]))
        text = scene.read_text()
        scene.write_text(text.replace('"type": "cable",', '"type": "cable", "length_scale": 3,'))
        self.assertNotEqual(scene.read_text(), text)
        run = coapt("solve", scene, "--max-seconds", 1)
        self.assertRegex(" ".join(self.result()["warnings"]), r"\d+ of \d+ chords and cables are slack")
        self.assertIn("are slack", run.stdout + run.stderr)

    def test_names_what_is_doubtful_about_a_valve_before_it_is_solved(self):
        scene = self.generate("mitral", "--triangles", 250)
        text = scene.read_text()
        scene.write_text(re.sub(r'("type": "load_pressure", "value": )"[^"]*"', r'\1"0.1 Pa"', text))
        self.assertNotEqual(scene.read_text(), text)
        self.assertRegex(coapt("check", scene).stdout, r"(?s)warning: .*: no defects, \d warnings? above, derivatives passed\n$")
        run = coapt("solve", scene, "--max-seconds", 1)
        self.assertRegex(run.stderr, r"coapt: warning: [^\n]*the pressure is 0\.00075\S* mmHg; hearts have")
        self.assertRegex(" ".join(self.result()["warnings"]), "the pressure is .* Check the unit of the pressure")

    def test_refuses_options_without_effect(self):
        for arguments, option in [(["disc", "--membrane", "stvk"], "--membrane"), (["disc", "--seed", 7], "--seed"),
                                  (["disc", "--model", "hammer-2008"], "--model"),
                                  (["mitral", "--model", "hammer-2008", "--membrane", "stvk"], "--model"),
                                  (["catenary", "--triangles", 7], "--triangles")]:
            self.assert_bad_input(coapt("generate", *arguments, "-o", self.folder / "new"), option, arguments[0])
        self.assertFalse((self.folder / "new").exists())
        scene = self.generate("mitral", "--triangles", 300)
        for name in ["x.obj", "x.feb"]:
            self.assert_bad_input(coapt("export", scene, "-o", self.folder / name, "--points", "nonsense"), "--points")
            self.assertFalse((self.folder / name).exists())
        run = coapt("import", self.folder / "valve.json", "-o", self.folder / "new", "--pressure", "volume")
        self.assertEqual(run.returncode, 2)
        self.assertIn("--pressure", run.stderr)
        self.assertNotIn("volume", coapt("import", "--help").stdout)

    def test_capital_letters_in_extensions_are_letters(self):
        scene = self.generate("mitral", "--triangles", 300)
        self.assertEqual(coapt("export", scene, "-o", self.folder / "V.FEB").returncode, 0)
        self.assertTrue((self.folder / "V.FEB").read_text().startswith("<?xml"))
        run = coapt("export", scene, "-o", self.folder / "T.MRK.JSON", "--points", "papillary")
        self.assertEqual((run.returncode, run.stderr), (0, ""))
        (self.folder / "valve.json").rename(self.folder / "VALVE.JSON")
        run = coapt("import", self.folder / "VALVE.JSON", "-o", self.folder / "new")
        self.assertEqual((run.returncode, run.stderr), (0, ""))

    def test_replaces_files_only_and_leaves_nothing_behind(self):
        scene = self.generate("mitral", "--triangles", 300)
        pipe, folder = self.folder / "pipe.feb", self.folder / "folder.feb"
        os.mkfifo(pipe)
        folder.mkdir()
        before = set(self.folder.iterdir())
        self.assert_bad_input(coapt("export", scene, "-o", pipe), "pipe.feb", "pipe")
        self.assert_bad_input(coapt("export", scene, "-o", folder), "folder.feb", "is a folder")
        self.assertTrue(stat.S_ISFIFO(pipe.stat().st_mode))
        self.assertEqual(set(self.folder.iterdir()), before)
        self.assert_bad_input(coapt("solve", self.folder), "is a folder")

    def test_says_when_its_output_is_lost(self):
        if not os.path.exists("/dev/full"):
            self.skipTest("skipped: no /dev/full")
        scene = self.generate("disc", "--triangles", 100)
        for arguments in [["schema", "scene"], ["--help"], ["solve", scene]]:
            with open("/dev/full", "w") as full:
                run = subprocess.run([COAPT, *map(str, arguments)], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(run.returncode, 5, arguments)
            self.assertIn("standard output", run.stderr)

    def test_names_every_defect_of_a_scene_on_its_own_line(self):
        scene = self.generate("disc", "--triangles", 100)
        text = scene.read_text().replace('"young": "1 MPa"', '"yuong": "1 MPa"').replace('"0.1 kPa"', '"0.1 kg"')
        scene.write_text(text)
        for command in ["solve", "check"]:
            run = coapt(command, scene)
            self.assert_bad_input(run, "yuong", "young", "0.1 kg")
            self.assertGreaterEqual(len(run.stderr.splitlines()), 2)
        self.assertFalse((self.folder / "result").exists(), "nothing half-written")

    def test_check_reports_scene_and_mesh_defects_in_one_pass(self):
        scene = self.generate("disc", "--triangles", 100)
        scene.write_text(scene.read_text().replace('"young": "1 MPa"', '"yuong": "1 MPa"'))
        with open(self.folder / "mesh.obj", "a") as mesh:
            mesh.write("f 1 2 99999\n")
        self.assert_bad_input(coapt("check", scene), "yuong", "mesh.obj", "99999")

    def test_check_prints_the_derivatives_of_every_term(self):
        run = coapt("check", self.generate("mitral", "--triangles", 300))
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        for name in ["leaflets", "chords", "load_pressure", "sum"]:
            self.assertIn(name, run.stdout)
        self.assertNotIn("FAILED", run.stdout)

    def test_lists_the_solvers_when_one_is_not_known(self):
        run = coapt("solve", self.generate("disc", "--triangles", 100), "--solver", "lbgfs")
        self.assert_bad_input(run, "lbgfs", "lbfgs", "bfgs")

    def test_says_why_a_scene_or_folder_cannot_be_used(self):
        self.assert_bad_input(coapt("solve", self.folder / "missing.json"), "missing.json")
        scene = self.generate("disc", "--triangles", 100)
        (self.folder / "file").write_text("")
        self.assert_bad_input(coapt("solve", scene, "-o", self.folder / "file"), "file", "-o")
        if os.geteuid() != 0:  # root writes anywhere
            locked = self.folder / "locked"
            locked.mkdir()
            locked.chmod(stat.S_IRUSR | stat.S_IXUSR)
            self.assert_bad_input(coapt("solve", scene, "-o", locked), "locked")

    def test_refuses_bad_arguments_with_2(self):
        for arguments in [["solve"], ["solve", "x", "--tolerance", "-1"], ["frobnicate"], ["generate", "cube", "-o", "x"],
                          ["generate", "catenary", "--contact", "facet", "-o", "x"], []]:
            run = coapt(*arguments, cwd=self.folder)
            self.assertEqual(run.returncode, 2, arguments)
            self.assertTrue(run.stderr.startswith("coapt: error: "), run.stderr)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_tells_version_components_and_licence(self):
        run = coapt("--version")
        self.assertEqual(run.returncode, 0)
        self.assertRegex(run.stdout, r"coapt \d+\.\d+\.\d+")
        self.assertIn("Licence:", run.stdout)
        self.assertIn("nanoflann", run.stdout)

    def test_prints_the_schemas(self):
        for which in ["scene", "result"]:
            self.assertIn("$schema", json.loads(coapt("schema", which).stdout))

    def test_two_runs_give_the_same_positions(self):
        scene = self.generate("mitral", "--triangles", 300)
        shapes = []
        for name in ["a", "b"]:
            coapt("solve", scene, "-o", self.folder / name)
            shapes.append((self.folder / name / "closed.obj").read_bytes())
        self.assertEqual(shapes[0], shapes[1])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
