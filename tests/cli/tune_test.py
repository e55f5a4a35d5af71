"""Drives `coapt tune` as a user does.

Usage: tune_test.py COAPT_BINARY [unittest arguments]
"""
import csv
import json
import math
import signal
import subprocess
import sys
import unittest

from command_case import COAPT, CommandCase, coapt


def longer(valve):
    """All chords that hang on the first tip, 5 % longer; junctions branch once."""
    chords = json.loads(valve.read_text())["chords"]
    trunks = [k for k, chord in enumerate(chords) if chord["from"].get("papillary") == 0]
    junctions = {chords[k]["to"].get("junction") for k in trunks}
    tree = trunks + [k for k, chord in enumerate(chords) if chord["from"].get("junction") in junctions]
    return json.dumps({"type": "chord_length", "chords": sorted(tree), "factor": 1.05})


class TuneTest(CommandCase):
    def valve(self):
        return self.generate("mitral", "--triangles", 250, "--contact", "none")

    def target(self, scene):
        """The closed surface of the same valve with longer chords on one tip."""
        other = self.folder / "other.json"
        other.write_text(scene.read_text().replace('"terms":', f'"interventions": [{longer(scene.parent / "valve.json")}],\n  "terms":', 1))
        run = coapt("solve", other, "-o", self.folder / "target")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return self.folder / "target" / "closed.vtp"

    def tune(self, scene, *options, code=0):
        run = coapt("tune", scene, "-o", self.folder / "out", *options, timeout=300)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run, self.read()

    def read(self):
        text = (self.folder / "out" / "tuning.json").read_text()
        self.assertNotIn("NaN", text)
        return json.loads(text)

    def test_fits_a_closed_surface(self):
        scene = self.valve()
        run, found = self.tune(scene, "--target", self.target(scene), "--by", "tip", "--noise", "0.02mm")
        self.assertEqual((found["status"], found["converged"]), ("converged", True))
        lengths = {length["name"]: length for length in found["lengths"]}
        self.assertEqual(set(lengths), {f"tip_{tip}" for tip in range(8)})
        self.assertAlmostEqual(lengths["tip_0"]["factor"], 1.05, places=2)
        self.assertAlmostEqual(lengths["tip_1"]["factor"], 1, places=2)
        self.assertFalse({"tip_0", "tip_1"} & set(found["undetermined"]))
        self.assertLess(found["rms_distance_mm"]["after"], 0.1 * found["rms_distance_mm"]["before"])
        self.assertEqual(found["solves"], len(found["history"]) + 2)
        self.assertIn("best", run.stdout)
        rows = list(csv.DictReader((self.folder / "out" / "tuning.csv").read_text().splitlines()))
        self.assertAlmostEqual(float(rows[0]["after_mm"]), lengths["tip_0"]["after_mm"], places=6)
        page = (self.folder / "out" / "report.html").read_text()
        for piece in ["Cost of each solve", "Rest lengths", "orifice_area_mm2", "tip_1"]:
            self.assertIn(piece, page)
        # The scene that it writes is solved by itself, to the same figures.
        alone = coapt("solve", self.folder / "out" / "tuned.json", "-o", self.folder / "alone")
        self.assertEqual(alone.returncode, 0, alone.stdout + alone.stderr)
        metrics = self.result(self.folder / "alone")["metrics"]
        for name in ["orifice_area_mm2", "leaflet_area_closed_mm2", "max_chord_force_n"]:
            self.assertTrue(math.isclose(metrics[name], found["metrics"][name]["after"], rel_tol=1e-3), name)
            self.assertIn(name, self.result(self.folder / "out" / "after")["metrics"])

    def test_is_cut_short_and_goes_on(self):
        scene = self.valve()
        kept = self.folder / "tune.checkpoint"
        options = ["--target", str(self.target(scene)), "--change-weight", "1e-6"]
        command = [COAPT, "tune", str(scene), "-o", str(self.folder / "out"), *options]
        process = subprocess.Popen([*command, "--checkpoint", str(kept)], stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.kill)
        was_drawn = False  # to the target, on the way to where the search begins
        for line in process.stdout:
            if was_drawn and "best" in line:
                break
            was_drawn = was_drawn or "drawn to the target" in line
        process.send_signal(signal.SIGINT)
        rest = process.stdout.read()
        process.stdout.close()
        self.assertEqual(process.wait(60), 1)
        self.assertIn("--resume", rest)
        cut = self.read()
        self.assertEqual((cut["status"], cut["converged"]), ("cancelled", False))
        self.assertLess(cut["cost"]["after"], cut["cost"]["before"])
        self.assert_bad_input(coapt("tune", scene, "-o", self.folder / "out", *options, "--checkpoint", kept),
                              "is there already")
        self.assert_bad_input(coapt("tune", scene, *options, "--resume", kept, "--bounds", "-10%..10%"),
                              "another bounds")
        run = coapt("tune", scene, "-o", self.folder / "out", *options, "--resume", kept, timeout=300)
        self.assertIn("resumed after", run.stdout)
        found = self.read()
        self.assertIn(found["status"], ["converged", "stalled"])
        self.assertGreater(len(found["history"]), len(cut["history"]))
        self.assertEqual(found["history"][0], cut["history"][0])
        self.assertLessEqual(found["cost"]["after"], cut["cost"]["after"])
        self.assertFalse(kept.exists())

    def test_refuses_all_that_is_wrong_at_once(self):
        scene = self.valve()
        run = coapt("tune", scene, "-o", self.folder / "out", "--target", self.folder / "none.obj", "--only", "tipp_0",
                    "--bounds", "20%..-20%", "--noise", "0.1", "--method", "simplex")
        self.assert_bad_input(run, "none.obj", '"tipp_0"; did you mean "tip_0"?', "--bounds: are reversed",
                              "--noise", '"simplex" is not known')
        self.assertFalse((self.folder / "out").exists())
        self.assert_bad_input(coapt("tune", scene), "--target: missing")
        self.assert_bad_input(coapt("tune", scene, "--bounds", "wide"), "--bounds: read")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
