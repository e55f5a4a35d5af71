"""What stands open, or is doubtful otherwise, is said by every command that solves several times, and green on no page.

Usage: doubt_test.py COAPT_BINARY [unittest arguments]
"""
import csv
import json
import re
import sys
import unittest

from command_case import CommandCase, coapt

OPEN = "the valve stands open"
RING = '{"type": "ring", "size": "28 mm", "stiffness": "flexible"}'


class DoubtTest(CommandCase):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"

    def open_valve(self):
        """Pressure from the atrium: every leaflet hangs into the ventricle."""
        scene = self.generate("mitral", "--triangles", 200)
        text = scene.read_text()
        scene.write_text(text.replace('"side": "front"', '"side": "back"'))
        self.assertNotEqual(scene.read_text(), text)
        return scene

    def solve_several(self, command, *arguments):
        run = coapt(command, *arguments, "-o", self.out, timeout=300)
        self.assertIn(run.returncode, (0, 1, 4), run.stdout + run.stderr)
        self.assertIn(OPEN, run.stdout)
        return run.stdout

    def document(self, name):
        return json.loads((self.out / name).read_text())

    def assert_page_doubts(self, name):
        page = (self.out / name).read_text()
        lead = re.search(r'<p class="lead (\w+)">(.*?)</p>', page)
        self.assertIsNotNone(lead, page[:2000])
        self.assertIn(lead[1], ("caution", "bad"))
        self.assertIn(OPEN, lead[2])
        self.assertNotRegex(page, r'class="good[^"]*">[^<]*converged')

    def test_a_study_says_that_its_points_stand_open(self):
        text = self.solve_several("study", self.open_valve(), "--sweep", "load_pressure.value=100,120mmHg", "-j", 1)
        self.assertIn("converged, in doubt", text)
        self.assert_page_doubts("study.html")
        for point in self.document("study.json")["points"]:
            self.assertIn(OPEN, point["doubts"][0])
        with (self.out / "study.csv").open() as file:
            self.assertTrue(all(OPEN in row["doubts"] for row in csv.DictReader(file)))

    def test_points_that_are_read_back_keep_their_doubts(self):
        scene = self.open_valve()
        arguments = (scene, "--sweep", "load_pressure.value=100,120mmHg", "-j", 1)
        self.solve_several("study", *arguments)
        run = coapt("study", *arguments, "-o", self.out, timeout=300)
        self.assertIn("2 of 2 points are there already", run.stdout)
        self.assertIn("converged, in doubt", run.stdout)
        self.assert_page_doubts("study.html")

    def test_an_intervention_says_that_both_states_stand_open(self):
        text = self.solve_several("intervene", self.open_valve(), "--edit", RING)
        self.assertEqual(text.count("converged, in doubt"), 2, text)
        self.assert_page_doubts("intervene.html")
        found = self.document("intervene.json")
        self.assertTrue(all(OPEN in found[state]["doubts"][0] for state in ("before", "after")))

    def test_a_comparison_says_that_its_shapes_stand_open(self):
        self.solve_several("compare", self.open_valve(), "--methods", "newton,lbfgs")
        self.assert_page_doubts("compare.html")
        self.assertTrue(all(OPEN in method["doubts"][0] for method in self.document("compare.json")["methods"]))

    def test_a_tuning_says_that_what_it_found_stands_open(self):
        self.solve_several("tune", self.open_valve(), "--force-weight", 1, "--by", "all", "--max-solves", 4)
        self.assert_page_doubts("tuning.html")
        self.assertIn(OPEN, self.document("tuning.json")["after"]["doubts"][0])

    def test_stiffness_by_regions_says_that_the_valve_stands_open(self):
        text = self.solve_several("tune-regions", self.open_valve(), "--yield-strain", 1, "--regions", 4, "--orifice", 5000)
        self.assertIn("before in doubt: ", text)
        found = self.document("region_tuning.json")
        self.assertTrue(all(OPEN in found[state]["doubts"][0] for state in ("before", "after")))

    def test_refinement_sensitivity_and_benchmark_say_that_the_valve_stands_open(self):
        scene = self.open_valve()
        self.solve_several("mesh-study", scene, "--levels", 1)
        self.assertTrue(all(OPEN in level["doubts"][0] for level in self.document("mesh_study.json")["levels"]))
        self.solve_several("sensitivity", scene, "--parameters", "chords.diameter")
        self.assertIn(OPEN, self.document("sensitivity.json")["doubts"][0])
        self.solve_several("bench", scene, "--methods", "newton", "--tolerances", "1e-4", "--levels", 0, "--repeats", 1)
        self.assertIn(OPEN, self.document("bench.json")["doubts"][0])
        self.assert_page_doubts("bench.html")

    def test_a_flipped_facet_is_a_doubt_of_every_point(self):
        scene = self.generate("mitral", "--triangles", 200)
        leaflets = self.folder / "leaflets.obj"
        lines = leaflets.read_text().splitlines()
        facets = [k for k, line in enumerate(lines) if line.startswith("f ")]
        which = facets[len(facets) // 2]
        f, a, b, c = lines[which].split()
        lines[which] = f"{f} {b} {a} {c}"
        leaflets.write_text("\n".join(lines) + "\n")
        run = coapt("study", scene, "--sweep", "load_pressure.value=100,120mmHg", "-j", 1, "-o", self.out, timeout=300)
        self.assertIn(run.returncode, (0, 1, 4), run.stdout + run.stderr)
        page = (self.out / "study.html").read_text()
        lead = re.search(r'<p class="lead (\w+)">(.*?)</p>', page)
        self.assertNotEqual(lead[1], "good")
        self.assertIn("against the neighbours", lead[2] + run.stdout)

    def test_leaflets_that_are_stretched_beyond_what_was_measured_are_in_doubt(self):
        run = coapt("solve", self.generate("mitral", "--triangles", 250, "--preset", "benchmark"), timeout=300)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertRegex(run.stdout.splitlines()[0], r"1 % of the leaflets strained above \d+ % \(in vivo: peaks of 13 \+- 4.7 %, Rausch 2011\)")
        self.assertRegex(run.stdout, r"p99 principal strain 0\.\d+ \(at most 0\.22\): not healthy")
        page = (self.folder / "result/report.html").read_text()
        self.assertEqual(re.search(r'<p class="lead (\w+)">', page)[1], "caution")

    def test_a_stability_in_doubt_is_exit_code_4_of_every_command(self):
        scene, loose = self.strips(), ("--tolerance", "0.1")
        for command in [("solve", scene, "--solver", "lbfgs"), ("compare", scene, "--methods", "lbfgs"),
                        ("study", scene, "--solver", "lbfgs", "--sweep", "cst_stvk.young=1,1.1MPa", "-j", 1),
                        ("mesh-study", scene, "--solver", "lbfgs", "--levels", 1),
                        ("sensitivity", scene, "--solver", "lbfgs", "--from-start", "--parameters", "cst_stvk.young"),
                        ("bench", scene, "--methods", "lbfgs", "--tolerances", "0.1", "--levels", 0, "--repeats", 1)]:
            run = coapt(*command, *(() if command[0] == "bench" else loose), "-o", self.out / command[0], timeout=300)
            self.assertEqual(run.returncode, 4, f"{command}: {run.stdout}{run.stderr}")
            self.assertIn("its stability is in doubt (a saddle", run.stdout, command[0])

    def test_a_valve_that_stands_open_is_no_exit_code_of_any_command(self):
        scene = self.open_valve()
        for command in [("solve",), ("intervene", "--edit", RING), ("mesh-study", "--levels", 1)]:
            run = coapt(command[0], scene, *command[1:], "-o", self.out / command[0], timeout=300)
            self.assertEqual(run.returncode, 0, f"{command}: {run.stdout}{run.stderr}")
            self.assertIn(OPEN, run.stdout, command[0])

    def test_a_plain_result_has_no_doubts(self):
        scene = self.generate("mitral", "--triangles", 200, "--preset", "closed")
        run = coapt("study", scene, "--sweep", "load_pressure.value=100,120mmHg", "-j", 1, "-o", self.out, timeout=300)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertNotIn("in doubt", run.stdout)
        self.assertRegex((self.out / "study.html").read_text(), r'<p class="lead good">2 of 2 points, all converged</p>')


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
