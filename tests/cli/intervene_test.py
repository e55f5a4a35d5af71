"""Drives `coapt intervene` and `coapt study` as a user does.

Usage: intervene_test.py COAPT_BINARY [unittest arguments]
"""
import csv
import json
import os
import signal
import subprocess
import sys
import time
import unittest

from command_case import COAPT, CommandCase, coapt

RING = '{"type": "ring", "size": "28 mm", "stiffness": "flexible"}'


class InterveneTest(CommandCase):
    def valve(self, triangles=300):
        return self.generate("mitral", "--triangles", triangles, "--contact", "barrier")

    def with_ring(self, triangles=300):
        scene = self.valve(triangles)
        scene.write_text(scene.read_text().replace('"terms":', f'"interventions": [{RING}],\n  "terms":', 1))
        return scene

    def read(self, name):
        return json.loads((self.folder / "out" / name).read_text())

    def rows(self, name):
        with (self.folder / "out" / name).open() as file:
            return list(csv.DictReader(file))

    def test_solves_before_and_after(self):
        run = coapt("intervene", self.valve(), "--edit", RING, "-o", self.folder / "out", timeout=300)
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        found = self.read("intervene.json")
        self.assertTrue(found["converged"])
        self.assertEqual(found["interventions"], [json.loads(RING)])
        annulus = found["figures"]["annulus_area_mm2"]
        self.assertLess(annulus["after"], annulus["before"])
        self.assertAlmostEqual(annulus["after"] - annulus["before"], annulus["change"], places=9)
        rows = {row["figure"]: row for row in self.rows("intervene.csv")}
        self.assertAlmostEqual(float(rows["annulus_area_mm2"]["after"]), annulus["after"], places=6)
        for state in ["before", "after"]:
            solved = self.result(self.folder / "out" / state)
            self.assertAlmostEqual(solved["metrics"]["annulus_area_mm2"], annulus[state], places=6)
        page = (self.folder / "out" / "intervene.html").read_text()
        self.assertRegex(page, r"annulus area<small>[^<]*</small></th><td class=\"plain text\">mm²</td>")
        self.assertNotIn("annulus_area_mm2", page)
        self.assertIn("ring: size 28 mm, stiffness flexible", page)
        self.assertIn("annulus_area_mm2", run.stdout)

    def test_an_edit_is_compared_with_the_scene_as_it_stands(self):
        scene = self.with_ring()
        longer = '{"type": "chord_length", "materials": "primary", "factor": 1.1}'
        run = coapt("intervene", scene, "--edit", longer, "--json", "-o", self.folder / "out", timeout=300)
        found = json.loads(run.stdout)
        self.assertEqual(found["interventions"], [json.loads(longer)])
        annulus = found["figures"]["annulus_area_mm2"]  # the ring is in both; measured to a millionth
        self.assertLess(abs(annulus["change"]), 1e-5 * annulus["before"])
        self.assertGreater(abs(found["figures"]["prolapse_height_mm"]["change"]), 0.01)

    def test_refuses_before_the_first_solve(self):
        scene = self.valve()
        self.assert_bad_input(coapt("intervene", scene, "-o", self.folder / "out"), "interventions: none")
        bad = '{"type": "clip", "at": [0.47], "width": "1 um", "depth": "1 um"}'
        self.assert_bad_input(coapt("intervene", scene, "--edit", bad, "-o", self.folder / "out"),
                              "interventions[0].at[0]", "grasps no vertex")
        self.assert_bad_input(coapt("intervene", scene, "--edit", "ring", "-o", self.folder / "out"), "--edit")
        self.assertFalse((self.folder / "out").exists())

    def study(self, scene, *options, code=0):
        run = coapt("study", scene, "-o", self.folder / "out", *options, timeout=300)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run, self.read("study.json")

    def test_sweeps_a_grid_and_ranks_it(self):
        scene = self.with_ring()
        run, found = self.study(scene, "--sweep", "ring.size=26..30mm:2", "--sweep", "chords.length_scale=1,1.05",
                                "-j", "2")
        self.assertEqual((found["point_count"], found["finished"], found["converged"]), (4, 4, True))
        areas = [point["metrics"]["orifice_area_mm2"] for point in found["points"]]
        self.assertEqual(areas, sorted(areas))
        values = {(p["values"]["ring.size"], p["values"]["chords.length_scale"]) for p in found["points"]}
        self.assertEqual(values, {(a, b) for a in ["26 mm", "30 mm"] for b in ["1", "1.05"]})
        for row, area in zip(self.rows("study.csv"), areas, strict=True):
            self.assertAlmostEqual(float(row["orifice_area_mm2"]), area, places=9)
        # Each point is what `solve` makes of that scene.
        best = found["points"][0]
        alone = self.result(self.folder / "out" / best["folder"])
        self.assertEqual(alone["metrics"]["orifice_area_mm2"], areas[0])
        self.assertIn("ring.size", (self.folder / "out" / "study.html").read_text())
        # The same again reads everything back; another order needs no solve.
        again, reversed_order = self.study(scene, "--sweep", "ring.size=26..30mm:2", "--sweep",
                                           "chords.length_scale=1,1.05", "--greatest")
        self.assertIn("4 of 4 points are there already", again.stdout)
        self.assertEqual([p["metrics"]["orifice_area_mm2"] for p in reversed_order["points"]], areas[::-1])

    def test_goes_on_after_it_was_killed(self):
        scene = self.with_ring(625)
        command = ["study", str(scene), "-o", str(self.folder / "out"), "--sweep", "ring.size=26..34mm:4", "-j", "1"]
        for number in [signal.SIGTERM, signal.SIGKILL]:
            process = subprocess.Popen([COAPT, *command], stdout=subprocess.PIPE, text=True)
            self.addCleanup(process.kill)
            while " of 4  ring.size" not in (line := process.stdout.readline()):
                self.assertTrue(line or process.poll() is None)
            process.send_signal(number)
            process.wait(60)
            process.stdout.close()
        finished = {path.parent.name for path in (self.folder / "out").glob("point_*/point.json")}
        self.assertGreaterEqual(len(finished), 2)
        self.assertLess(len(finished), 4)
        kept = {name: os.stat(self.folder / "out" / name / "point.json").st_mtime_ns for name in finished}
        time.sleep(0.5)  # the worker of the killed study ends with it
        run, found = self.study(scene, *command[4:])
        self.assertIn("points are there already", run.stdout)
        self.assertEqual((found["finished"], found["converged"]), (4, True))
        for name, written in kept.items():
            self.assertEqual(os.stat(self.folder / "out" / name / "point.json").st_mtime_ns, written)

    def test_says_which_points_cannot_be_solved(self):
        scene = self.with_ring()
        self.assert_bad_input(coapt("study", scene, "--sweep", "ring.size=-5..5mm:2"), "ring.size=-5 mm",
                              "interventions[0].size", "greater than 0")
        self.assert_bad_input(coapt("study", scene, "--sweep", "rung.size=26..30"), "did you mean \"ring\"")
        self.assert_bad_input(coapt("study", scene, "--sweep", "ring.size=26..30", "--rank-by", "orifice_area"),
                              "did you mean \"orifice_area_mm2\"", "coaptation_height_mm")
        _, found = self.study(scene, "--sweep", "solver.max_iterations=2,1000", code=1)
        self.assertEqual([p["status"] for p in found["points"]], ["converged", "iteration_limit"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
