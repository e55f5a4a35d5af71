"""What programs read: one JSON document of every command, nothing where quiet is wanted, progress in a log.

Usage: json_test.py COAPT_BINARY [unittest arguments]
"""
import json
import os
import pty
import re
import subprocess
import unittest

from command_case import COAPT, CommandCase, coapt


class Json(CommandCase):
    def document(self, *arguments, codes=(0,)):
        run = coapt(*arguments, "--json")
        self.assertIn(run.returncode, codes, run.stdout + run.stderr)
        return json.loads(run.stdout)

    def test_every_command_has_its_document(self):
        out = self.folder / "out"
        valve, disc = out / "valve", out / "disc"
        self.assertEqual(self.document("generate", "mitral", "--triangles", 250, "-o", valve)["written"],
                         [str(valve / "scene.json")])
        self.document("generate", "disc", "--triangles", 100, "-o", disc)
        scene, flat = valve / "scene.json", disc / "scene.json"
        solved = self.document("solve", scene, codes=(0, 4))
        written = self.result(valve / "result")
        del solved["peak_memory_mb"], written["peak_memory_mb"]  # each says it of the time when it was made
        self.assertEqual(solved, written)
        checked = self.document("check", scene)
        self.assertTrue(checked["sound"])
        self.assertEqual(checked["defects"], [])
        self.assertGreater(len(checked["derivatives"]), 3)
        self.assertIn(self.document("check", scene, "--repair", "push")["outcome"], ["nothing_to_repair", "repaired"])
        imported = self.document("import", valve / "valve.json", "-o", out / "imported")
        self.assertEqual(imported["written"], [str(out / "imported" / "scene.json")])
        self.document("chords", valve / "leaflets.obj", "-o", out / "chords" / "valve.json")
        self.assertIn("warnings", self.document("export", scene, "-o", out / "valve.feb"))
        self.assertIn("$schema", self.document("schema", "scene"))
        self.assertIn("levels", self.document("mesh-study", flat, "--levels", 1))
        self.document("sensitivity", flat)
        self.document("tune", scene, "--orifice-weight", 1, "--by", "all", "--max-solves", 2, codes=(0, 1))
        self.document("tune-regions", scene, "--yield-strain", 0.5, "--regions", 4, codes=(0, 1))
        self.document("intervene", scene, "--edit", '{"type": "ring", "size": "34 mm"}', codes=(0, 1))
        self.document("study", flat, "--sweep", "terms[0].young=1MPa,2MPa", codes=(0, 1, 2))
        self.document("compare", flat, "--methods", "newton,lbfgs")
        self.document("register", valve / "result" / "closed.obj",
                      valve / "leaflets.obj", "-o", out / "registered")
        self.document("bench", flat, "--levels", 0, "--repeats", 1, "--methods", "newton", "--tolerances", "1e-2,1e-4")
        rows = self.document("stress", "--list")["rows"]
        self.assertIn("S1", [row["row"].split(".")[0].split("-")[0][:2] for row in rows])

    def test_errors_are_a_document_too(self):
        for arguments in [["solve", "missing.json"], ["slove"], ["solve"], ["solve", "x", "--tolrance", 1],
                          ["generate", "cube", "-o", self.folder / "x"]]:
            run = coapt(*arguments, "--json")
            self.assertEqual(run.returncode, 2, arguments)
            document = json.loads(run.stdout)
            self.assertEqual(list(document), ["error"])
            for defect in document["error"]:
                self.assertIn(defect, run.stderr)
        scene = self.generate("disc", "--triangles", 100)
        scene.write_text(scene.read_text().replace('"young"', '"yuong"'))
        run = coapt("check", scene, "--json")
        self.assertEqual(run.returncode, 2)
        document = json.loads(run.stdout)
        self.assertFalse(document["sound"])
        self.assertRegex(" ".join(document["defects"]), "yuong")

    def test_quiet_is_quiet(self):
        run = coapt("generate", "disc", "--triangles", 100, "-o", self.folder, "--quiet")
        self.assertEqual((run.returncode, run.stdout, run.stderr), (0, "", ""))
        run = coapt("solve", self.folder / "scene.json", "-q")
        self.assertEqual((run.returncode, run.stdout, run.stderr), (0, "", ""))
        self.assert_bad_input(coapt("solve", "missing.json", "--quiet"), "no such file")
        self.assert_bad_input(coapt("solve", "x", "--quiet", "--json"), "--quiet")

    def test_verbose_shows_every_iterate(self):
        scene = self.generate("disc", "--triangles", 100)
        run = coapt("solve", scene, "--verbose", keeps_progress=True)
        lines = re.findall(r"(?m)^  step \d+, \d+ nodes, iteration (\d+), residual \S+ \(wanted \S+\), [\d.]+ s", run.stderr)
        self.assertEqual(len(lines), len((self.folder / "result" / "trace.csv").read_text().splitlines()) - 1)

    def test_progress_tells_the_share_of_a_path(self):
        def shares(scene, *options):
            run = coapt("solve", scene, "--verbose", *options, keeps_progress=True)
            told = [int(share) for share in re.findall(r", path (\d+) %, residual \S+ \(wanted", run.stderr)]
            self.assertEqual(told, sorted(told))
            return sorted(set(told))

        disc = self.generate("disc", "--triangles", 100)
        self.assertEqual(shares(disc), [])
        self.assertEqual(shares(disc, "--damped-steps", 4), [25, 75, 100])  # a stable shape: the next step is twice as long
        valve = self.generate("mitral", "--triangles", 200, "--contact", "none")
        valve.write_text(valve.read_text().replace('"boundary":', '"motion": {"steps": 3}, "boundary":', 1))
        self.assertEqual(shares(valve, "--damped-steps", 0, "--max-seconds", 20)[:2], [33, 67])

    def test_progress_tells_the_mesh_of_a_cascade_and_what_follows_the_solve(self):
        run = coapt("solve", self.generate("mitral", "--triangles", 3000), "--verbose", keeps_progress=True)
        told = [line for line in run.stderr.splitlines() if line.startswith("  ")]
        phases = [line.split(",")[0].strip() for line in told]
        order = list(dict.fromkeys(phases))
        self.assertRegex(order[0], r"^mesh 1 of \d$", run.stderr)
        self.assertEqual(order[-3:], ["finest mesh", "certificate", "sliders of the page"])
        wanted = {phase: re.search(r"\(wanted (\S+)\)", line)[1] for phase, line in zip(phases, told) if "step" in line}
        self.assertGreater(float(wanted[order[0]]), float(wanted["finest mesh"]))

    def test_a_log_has_a_line_every_five_seconds(self):
        scene = self.generate("mitral", "--triangles", 60000)
        run = coapt("solve", scene, "--tolerance", "1e-13", "--max-seconds", 12, keeps_progress=True)
        lines = [line for line in run.stderr.splitlines() if re.match(r"  (mesh \d of \d, |finest mesh, )?step ", line)]
        self.assertIn(len(lines), [1, 2, 3], run.stderr)

    def test_every_command_tells_the_residual_that_is_wanted(self):
        scene = self.generate("disc", "--triangles", 100)
        for command, *options in [("compare", "--methods", "newton"), ("mesh-study", "--levels", 1), ("sensitivity",)]:
            run = coapt(command, scene, "-o", self.folder / command, "--verbose", *options, keeps_progress=True)
            lines = [line for line in run.stderr.splitlines() if line.startswith("  step ")]
            self.assertGreater(len(lines), 0, run.stderr)
            self.assertEqual([line for line in lines if "(wanted 1e-08)" not in line], [], command)

    def test_commands_that_solve_to_several_residuals_tell_which_is_wanted(self):
        scene = self.generate("mitral", "--triangles", 200)
        for command, *options in [("bench", "--methods", "newton", "--tolerances", "1e-2,1e-4", "--levels", 0, "--repeats", 1),
                                  ("tune", "--force-weight", 1, "--by", "all", "--max-solves", 2)]:
            run = coapt(command, scene, "-o", self.folder / command, "--verbose", *options, keeps_progress=True)
            lines = [line for line in run.stderr.splitlines() if line.startswith("  step ")]
            self.assertGreater(len(lines), 0, run.stderr)
            self.assertEqual([line for line in lines if not re.search(r"\(wanted \S+\)", line)], [], command)

    def test_a_study_tells_how_many_points_are_through(self):
        scene = self.generate("mitral", "--triangles", 20000)
        run = coapt("study", scene, "--sweep", "load_pressure.value=100,120,140mmHg", "-j", 1, "--max-seconds", 6,
                    "-o", self.folder / "out", keeps_progress=True)
        self.assertRegex(run.stderr, r"(?m)^  [012] of 3 points, \d+\.\d s(, about [\d.]+ s left)?$")
        self.assertNotIn("step", run.stderr)

    def test_a_quiet_study_says_which_points_were_refused(self):
        scene = self.generate("disc", "--triangles", 100)
        run = coapt("study", scene, "--sweep", "load_pressure.value=1,2kPa", "--solver", "nwton", "-q", "-j", 1,
                    "-o", self.folder / "out")
        self.assertEqual((run.returncode, run.stdout), (1, ""))
        self.assertEqual(len(run.stderr.splitlines()), 2, run.stderr)
        for line, value in zip(run.stderr.splitlines(), ["1 kPa", "2 kPa"]):
            self.assertTrue(line.startswith(f"coapt: error: load_pressure.value = {value}  "), line)

    def test_a_terminal_has_one_line(self):
        scene = self.generate("mitral", "--triangles", 2500)
        ours, theirs = pty.openpty()
        run = subprocess.Popen([COAPT, "solve", str(scene)], stdout=subprocess.DEVNULL, stderr=theirs)
        os.close(theirs)
        shown = b""
        while True:
            try:
                piece = os.read(ours, 65536)
            except OSError:
                break
            if not piece:
                break
            shown += piece
        os.close(ours)
        self.assertIn(run.wait(), [0, 1, 4])
        self.assertRegex(shown, rb"\r  step \d+, ")
        self.assertNotIn(b"\n  step", shown)
        self.assertTrue(shown.endswith(b"\r\x1b[K"), shown[-200:])


if __name__ == "__main__":
    unittest.main(argv=[__file__])
