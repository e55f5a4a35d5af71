"""Drives `coapt tune` as a user does.

Usage: tune_test.py COAPT_BINARY [unittest arguments]
"""
import csv
import html
import json
import math
import re
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

    def table(self, page, caption):
        """The cells of a table of the page, row by row."""
        body = page.split(f"<caption>{caption}</caption>")[1].split("</table>")[0].split("<tbody>")[1]
        return [[html.unescape(re.sub("<[^>]*>", "", cell)) for cell in re.findall("<t[hd].*?</t[hd]>", row, re.DOTALL)]
                for row in re.findall("<tr>.*?</tr>", body, re.DOTALL)]

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
        page = (self.folder / "out" / "tuning.html").read_text()
        for piece in ["Cost of each solve", "Rest lengths", "orifice area", "mm²", "tip_1", "What the target determines",
                      "Singular value of each combination of lengths"]:
            self.assertTrue(piece in page, piece)
        rows = self.table(page, "Combinations of lengths")
        self.assertEqual(len(rows), len(found["spectrum"]))
        for number, (row, direction) in enumerate(zip(rows, found["spectrum"]), 1):
            self.assertEqual((row[0], row[3]), (str(number), "yes" if direction["determined"] else "no"))
            self.assertAlmostEqual(float(row[1]), direction["singular_value"], delta=0.01 * direction["singular_value"])
            deviation = direction["standard_deviation_mm"]
            if deviation is None:
                self.assertEqual(row[2], "–")
            else:
                self.assertAlmostEqual(float(row[2]), deviation, delta=0.01 * deviation)
            for name in direction["main_lengths"]:
                self.assertIn(name, row[4])
        self.assertIn("yes", [row[3] for row in rows])
        # The scene that it writes is solved by itself, to the same figures.
        alone = coapt("solve", self.folder / "out" / "tuned.json", "-o", self.folder / "alone")
        self.assertEqual(alone.returncode, 0, alone.stdout + alone.stderr)
        metrics = self.result(self.folder / "alone")["metrics"]
        for name in ["orifice_area_mm2", "leaflet_area_closed_mm2", "max_chord_force_n"]:
            self.assertTrue(math.isclose(metrics[name], found["metrics"][name]["after"], rel_tol=1e-3), name)
            self.assertIn(name, self.result(self.folder / "out" / "tuned")["metrics"])

    def test_lessens_orifice_or_chord_force(self):
        scene = self.valve()
        if not re.search("^  with +NLopt", coapt("--version").stdout, re.MULTILINE):
            self.skipTest("skipped: built without NLopt")
        figures = {}
        for name, weights in {"orifice": (1, 0.01), "force": (0.01, 1)}.items():
            _, found = self.tune(scene, "--orifice-weight", weights[0], "--force-weight", weights[1], "--change-weight",
                                 0, "--by", "tip", "--bounds=-5%..5%", "--max-solves", 100)
            self.assertEqual((found["weights"]["orifice_per_mm2"], found["weights"]["force_per_n"]), weights)
            self.assertIsNone(found["spectrum"])
            self.assertNotIn("What the target determines", (self.folder / "out" / "tuning.html").read_text())
            self.assertLess(found["cost"]["after"], 0.95 * found["cost"]["before"])
            for length in found["lengths"]:
                self.assertTrue(0.95 - 1e-9 <= length["factor"] <= 1.05 + 1e-9, length)
            figures[name] = found["metrics"]
        orifice, force = figures["orifice"]["orifice_area_mm2"], figures["force"]["max_chord_force_n"]
        self.assertLess(orifice["after"], 0.8 * orifice["before"])
        self.assertLess(force["after"], 0.93 * force["before"])
        self.assertLess(orifice["after"], 0.8 * figures["force"]["orifice_area_mm2"]["after"])
        self.assertLess(force["after"], 0.95 * figures["orifice"]["max_chord_force_n"]["after"])

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
                              "another pair of bounds (-0.2 to 0.2 there, -0.1 to 0.1 here)")
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
