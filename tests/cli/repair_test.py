"""Starts that touch or intersect: what the command says of them and how it repairs them.

Usage: repair_test.py COAPT_BINARY [unittest arguments]
"""
import json
import sys
import unittest

from command_case import CommandCase, coapt


class RepairTest(CommandCase):
    def two_sheets(self, second, **contact):
        """A scene of a clamped 6 x 6 sheet and a second one, given by its positions (x, y in cells), under pressure."""
        grid = [(i, j) for j in range(7) for i in range(7)]
        lines = [f"v {i} {j} 0" for i, j in grid] + ["v {} {} {}".format(*second(i, j)) for i, j in grid]
        for name, first in [("lower", 1), ("upper", 50)]:
            lines.append(f"g {name}")
            for corner in (first + i + 7 * j for j in range(6) for i in range(6)):
                lines += [f"f {corner} {corner + 1} {corner + 8}", f"f {corner} {corner + 8} {corner + 7}"]
        (self.folder / "mesh.obj").write_text("\n".join(lines) + "\n")
        scene = {"mesh": {"file": "mesh.obj"}, "boundary": [{"nodes": "boundary", "fix": True}],
                 "terms": [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm",
                            "prestress": "0.01 N/mm"},
                           {"type": "load_pressure", "value": "0.1 kPa"}, {"type": "contact_barrier", **contact}]}
        path = self.folder / "scene.json"
        path.write_text(json.dumps(scene))
        return path, scene

    def poking_sheets(self):
        # Above the first sheet, but for one vertex that pokes through a face.
        return self.two_sheets(lambda i, j: (i + 0.3, j + 0.2, -0.1 if (i, j) == (3, 3) else 0.3))

    def test_refuses_a_start_that_intersects_naming_the_pairs(self):
        path, _ = self.poking_sheets()
        for command in ["solve", "check"]:
            run = coapt(command, path)
            self.assert_bad_input(run, "terms[2]", "pairs of facets", "--repair push", "numbered from 0")
            self.assertRegex(run.stderr, r"\(\d+-\d+, ")
        self.assertFalse((self.folder / "result").exists())

    def test_repair_pushes_sheets_apart(self):
        path, scene = self.poking_sheets()
        run = coapt("check", path, "--repair", "push")
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        for piece in ["mesh.separated.obj", "passes", "largest move", "mm"]:
            self.assertIn(piece, run.stdout)
        pushed = (self.folder / "mesh.separated.obj").read_text()
        self.assertIn("g upper", pushed, "regions are kept")
        scene["mesh"]["file"] = "mesh.separated.obj"
        path.write_text(json.dumps(scene))
        run = coapt("check", path)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertEqual(coapt("solve", path).returncode, 0)
        self.assertEqual(self.result()["metrics"]["intersections"], 0)
        run = coapt("check", path, "--repair", "push")
        self.assertEqual(run.returncode, 0)
        self.assertIn("nothing to repair", run.stdout)

    def test_import_repairs_slivers_or_names_them(self):
        mesh, out = self.folder / "sheet.obj", self.folder / "out"
        grid = [(3 - 1e-6, 3) if (i, j) == (2, 3) else (i, j) for j in range(7) for i in range(7)]
        lines = [f"v {x} {y} 0" for x, y in grid]
        for corner in (1 + i + 7 * j for j in range(6) for i in range(6)):
            lines += [f"f {corner} {corner + 1} {corner + 8}", f"f {corner} {corner + 8} {corner + 7}"]
        mesh.write_text("\n".join(lines) + "\n")
        run = coapt("import", mesh, "-o", out)
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        for piece in ["repaired 2 slivers (triangles ", "1 edge collapsed", "mm", "repairs.csv"]:
            self.assertIn(piece, run.stdout)
        self.assertTrue((out / "repairs.csv").read_text().startswith("step,triangles,"))
        run = coapt("check", out / "scene.json")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertNotIn("sliver", run.stdout)
        run = coapt("import", mesh, "-o", out, "--no-repair")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("slivers, longest edge up to", run.stdout)
        self.assertFalse((out / "repairs.csv").exists())
        run = coapt("check", out / "scene.json")
        self.assertIn("slivers, longest edge up to", run.stdout, run.stderr)
        mesh.write_text("v 0 0 0\nv 10 0 0\nv 5 1e-6 0\nf 1 2 3\n")
        self.assert_bad_input(coapt("import", mesh, "-o", self.folder / "none"), "sheet.obj", "triangle 1, counted from 1", "--no-repair")
        self.assertFalse((self.folder / "none").exists())

    def test_import_refuses_a_valve_of_impossible_size_but_no_tent(self):
        scene = coapt("generate", "mitral", "--preset", "benchmark", "--triangles", 300, "-o", self.folder / "valve")
        self.assertEqual(scene.returncode, 0, scene.stderr)
        valve = json.loads((self.folder / "valve/valve.json").read_text())
        file, out = self.folder / "valve/misread.json", self.folder / "out"
        for unit, size in [("m", "e+04 mm across"), ("um", "mm across")]:
            file.write_text(json.dumps({**valve, "units": unit}))
            run = coapt("import", file, "-o", out)
            self.assert_bad_input(run, "misread.json", size, "Check the unit of the mesh", "--any-size")
            self.assertFalse(out.exists())
        file.write_text(json.dumps({**valve, "units": "m"}))
        run = coapt("import", file, "-o", out, "--any-size")
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        self.assertIn("Check the unit of the mesh", run.stdout)
        run = coapt("import", self.folder / "valve/valve.json", "-o", out)
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        tent = self.folder / "tent.obj"
        tent.write_text("".join(f"v {6000 * i} {6000 * j} 0\n" for j in range(4) for i in range(4)) + "".join(
            f"f {c} {c + 1} {c + 5}\nf {c} {c + 5} {c + 4}\n" for c in (1 + i + 4 * j for j in range(3) for i in range(3))))
        run = coapt("import", tent, "-o", self.folder / "tent")
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        self.assertIn("mm across", run.stdout)

    def test_repair_cannot_move_what_is_held(self):
        path, scene = self.two_sheets(lambda i, j: (i + 0.3, j + 0.2, 0))
        scene["boundary"][0]["nodes"] = "all"
        path.write_text(json.dumps(scene))
        before = set(self.folder.iterdir())
        run = coapt("check", path, "--repair", "push")
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        for piece in ["are left", "nothing was written", "--repair exclude"]:
            self.assertIn(piece, run.stdout)
        self.assertEqual(set(self.folder.iterdir()), before)

    def test_repair_excludes_pairs(self):
        path, scene = self.poking_sheets()
        run = coapt("check", path, "--repair", "exclude")
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        self.assertIn('"exclude": "scene.exclude.csv"', run.stdout)
        scene["terms"][2]["exclude"] = "scene.exclude.csv"
        path.write_text(json.dumps(scene))
        run = coapt("solve", path)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertIn("nothing to repair", coapt("check", path, "--repair", "exclude").stdout)
        list_file = self.folder / "scene.exclude.csv"
        list_file.write_text(list_file.read_text() + "1,2\n3;4\n5,999\n")
        number = len(list_file.read_text().splitlines())
        run = coapt("check", path)
        self.assert_bad_input(run, f"scene.exclude.csv:{number - 1}: ", f"scene.exclude.csv:{number}: ", "0 to 143")

    def test_excluded_coincident_sheets_are_solved(self):
        path, scene = self.two_sheets(lambda i, j: (i, j, 0))
        self.assert_bad_input(coapt("solve", path), "pairs of facets")
        self.assertEqual(coapt("check", path, "--repair", "exclude").returncode, 0)
        scene["terms"][2]["exclude"] = "scene.exclude.csv"
        path.write_text(json.dumps(scene))
        run = coapt("solve", path)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    def test_refuses_the_barrier_with_solvers_that_choose_their_steps_themselves(self):
        path, _ = self.two_sheets(lambda i, j: (i, j, 1))
        for solver in ["ceres", "nlopt"]:
            run = coapt("solve", path, "--solver", solver)
            if "is not known" not in run.stderr:  # in this build
                self.assert_bad_input(run, f'"{solver}"', "contact_barrier")

    def test_repair_writes_where_it_is_told_to_and_says_where_it_does_not_apply(self):
        path, scene = self.poking_sheets()
        for method, name in [("push", "out.ply"), ("exclude", "out.csv")]:
            run = coapt("check", path, "--repair", method, "-o", self.folder / name)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            self.assertTrue((self.folder / name).exists())
        for arguments in [["--repair", "pull"], ["-o", "x"]]:
            run = coapt("check", path, *arguments)
            self.assertEqual(run.returncode, 2, run.stdout)
            self.assertIn("--repair", run.stderr)
        run = coapt("check", self.generate("disc", "--triangles", 100), "--repair", "push")
        self.assertEqual(run.returncode, 0)
        self.assertIn("no contact_barrier", run.stdout)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
