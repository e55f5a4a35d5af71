"""Drives `coapt bench` and `coapt solve --accuracy` as a user does.

Usage: bench_test.py COAPT_BINARY RESULT_SCHEMA [unittest arguments]
"""
import csv
import json
import pathlib
import sys
import unittest

import command_case

SCHEMA = json.loads(pathlib.Path(sys.argv[2]).read_text())


def coapt(*arguments, **options):
    return command_case.coapt(*arguments, timeout=200, **options)


class BenchTest(command_case.CommandCase):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "result"

    def bench(self, scene, *arguments, code=0):
        run = coapt("bench", scene, "-o", self.out, *arguments)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        self.assertEqual(run.stderr, "")
        rows = list(csv.DictReader((self.out / "bench.csv").read_text().splitlines()))
        return run.stdout, json.loads((self.out / "bench.json").read_text()), rows

    def test_a_valve_gets_a_recommendation(self):
        scene = self.generate("mitral", "--triangles", 300, "--contact", "none")
        text, found, rows = self.bench(scene, "--methods", "newton,lbfgs", "--tolerances", "1e-3,1e-6",
                                       "--repeats", 2)
        self.assertEqual(len(rows), 8)
        self.assertEqual([row["method"] for row in rows], 2 * (2 * ["newton"] + 2 * ["lbfgs"]))
        self.assertEqual([mesh["benchmarked"] for mesh in found["meshes"]], [True, True, False])
        for row, run in zip(rows, found["runs"]):
            self.assertEqual(row["status"], "converged")
            self.assertAlmostEqual(float(row["total_mm"]), run["errors"]["total_mm"], places=9)
            self.assertGreaterEqual(run["wall_s"]["median"], run["wall_s"]["best"])
            self.assertGreater(sum(run["time_by_phase_s"].values()), 0)
            phases = dict(pair.split("=") for pair in row["phases_s"].split(";"))
            self.assertEqual(set(phases), set(run["time_by_phase_s"]))
            unit = found["meshes"][run["mesh"]]["factorisation_s"]
            self.assertAlmostEqual(run["cpu_in_factorisations"] * unit, run["cpu_s"]["median"], places=9)
            self.assertIn(run["repeats"], (1, 2))  # not again where the first took 10 s
        # Each entry of the table of times is a run that is that exact, and none of those was faster.
        for entry in found["time_to"]:
            if entry["wall_s"] is None:
                continue
            total = entry["error"] == "total"
            errors = [(run["errors"]["total_mm"] if total else run["errors"]["algebraic"]["max_mm"],
                       run["wall_s"]["median"]) for run in found["runs"]
                      if run["method"] == entry["method"] and (total or run["mesh"] == entry["mesh"])]
            self.assertEqual(entry["wall_s"],
                             min(seconds for error, seconds in errors if error <= entry["accuracy_mm"]))
        self.assertEqual(len(found["recommendations"]), 3)
        for line in found["recommendations"]:
            self.assertIn(line, text)
        self.assertRegex(found["recommendations"][0], r"^for 1 mm on this scene: (newton|lbfgs), [\d,]+ triangles, ")
        page = (self.out / "bench.html").read_text()
        self.assertIn('<figure class="plot">', page)
        for word in ['src="http', 'href="http', "@import"]:
            self.assertNotIn(word, page)

    def test_says_that_methods_end_in_different_equilibria(self):
        scene = self.generate("mitral", "--triangles", 625, "--membrane", "stvk")
        text, found, _ = self.bench(scene, "--methods", "lbfgs,newton", "--reference", "lbfgs", "--tolerances", "1e-6",
                                    "--levels", 0, "--repeats", 1, "--branches", 1)
        self.assertEqual([end["verdict"] for end in found["ends"]], ["reference", "another branch"])
        self.assertEqual(len(found["other_equilibria"]), 2)
        self.assertRegex(found["other_equilibria"][0], r"^newton on \d+ triangles ends in another equilibrium than lbfgs")
        self.assertIn(found["branches"]["message"], found["other_equilibria"][1])
        page = (self.out / "bench.html").read_text()
        for line in found["other_equilibria"]:
            self.assertIn(line, text)
            self.assertIn(line, page)

    def test_json_on_request(self):
        scene = self.generate("disc", "--triangles", 100)
        run = coapt("bench", scene, "-o", self.out, "--methods", "newton", "--levels", 0, "--tolerances", "1e-4",
                    "--json")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(json.loads(run.stdout), json.loads((self.out / "bench.json").read_text()))

    def test_a_stop_is_no_success(self):
        scene = self.generate("disc", "--triangles", 100)
        text, found, rows = self.bench(scene, "--methods", "newton,xpbd", "--levels", 0, "--tolerances", "1e-4,1e-6",
                                       code=1)
        self.assertIn("stopped early", text)
        self.assertFalse(found["converged"])
        self.assertEqual([row["method"] for row in rows], ["newton", "newton", "xpbd"])
        self.assertEqual(rows[2]["algebraic_max_mm"], "")  # constraints have no energy of the scene
        self.assertGreater(float(rows[2]["method_mm"]), 0)

    def test_bad_input(self):
        scene = self.generate("disc", "--triangles", 100)
        self.assert_bad_input(coapt("bench", scene, "-o", self.out, "--methods", "newtn", "--tolerances", "2"),
                              'did you mean "newton"', "above 0 and at most 1")
        self.assert_bad_input(coapt("bench", scene, "-o", self.out, "--tolerances", "1e-2,tight"),
                              "--tolerances", "tight")
        self.assertFalse(self.out.exists())

    # --- solve --accuracy

    def test_accuracy_chooses_mesh_and_tolerance(self):
        scene = self.generate("disc", "--triangles", 100)
        run = coapt("solve", scene, "-o", self.out, "--accuracy", "0.02mm")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        result = json.loads((self.out / "result.json").read_text())
        accuracy = result["accuracy"]
        self.assertTrue(accuracy["reached"])
        self.assertEqual(accuracy["wanted_mm"], 0.02)
        self.assertLessEqual(accuracy["total_mm"], 0.02)
        self.assertIn(accuracy["message"], run.stdout)
        told = run.stderr.splitlines()
        for solve in accuracy["solves"]:
            self.assertTrue(any(line.startswith(f"  {solve['triangles']} triangles in ") for line in told), run.stderr)
        self.assertEqual(sum("of the surface moved by up to" in line for line in told), len(told) - 1, run.stderr)
        self.assertIn("error by estimate", told[-1])
        first = accuracy["solves"][0]["triangles"]
        self.assertEqual(result["mesh"]["triangles"], first * 4 ** accuracy["cuts"])
        wanted = SCHEMA["properties"]["accuracy"]
        self.assertEqual(set(accuracy), set(wanted["required"]))
        self.assertEqual(set(accuracy["solves"][0]), set(wanted["properties"]["solves"]["items"]["required"]))

    def test_accuracy_refuses_what_it_cannot_read(self):
        scene = self.generate("disc", "--triangles", 100)
        self.assert_bad_input(coapt("solve", scene, "-o", self.out, "--accuracy", "0.1"), "--accuracy", "length")
        self.assert_bad_input(coapt("solve", scene, "-o", self.out, "--accuracy", "0.1 kPa"), "--accuracy", "length")
        self.assert_bad_input(coapt("solve", scene, "-o", self.out, "--accuracy", "0.1mm", "--tolerance", "1e-3"),
                              "leave --tolerance out")
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
