"""Drives `coapt stress` as a user does.

Usage: stress_test.py COAPT_BINARY [unittest arguments]
"""
import csv
import json
import signal
import subprocess
import sys
import unittest

import command_case
from command_case import COAPT


def coapt(*arguments, **options):
    return command_case.coapt(*arguments, timeout=600, **options)


class StressTest(command_case.CommandCase):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "out"

    def disc(self):
        return self.generate("disc", "--triangles", 100)

    def test_the_quick_matrix_has_no_failure(self):
        run = coapt("stress", "--quick", "-o", self.out)
        found = json.loads((self.out / "stress.json").read_text())
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertEqual(run.stderr, "")
        self.assertTrue(found["holds"], run.stdout)
        self.assertEqual(found["counts"]["fail"], 0, run.stdout)
        self.assertEqual([r["name"] for r in found["rows"] if r["message"].startswith("refused")], [])
        self.assertGreater(found["counts"]["pass"], 30, run.stdout)
        self.assertLess(found["counts"]["stall"], 5, run.stdout)
        self.assertTrue({"S1", "S3", "S5", "S8", "S9", "S10", "S12", "S14", "S15", "S16", "S17", "S19", "S20", "S21", "S23", "S24"}
                        <= {r["id"] for r in found["rows"]})
        rows = list(csv.DictReader((self.out / "stress.csv").read_text().splitlines()))
        self.assertEqual([r["message"] for r in rows], [r["message"] for r in found["rows"]])
        for row in found["rows"]:
            self.assertIn(row["name"], run.stdout)
            if row["verdict"] == "pass" and row["limit"] is not None:
                self.assertLessEqual(row["figure"], row["limit"], row["name"])
        threads = {r["scene"]: r["verdict"] for r in found["rows"] if r["id"] == "S19"}
        self.assertEqual(threads, {"valve": "n/a", "large valve": "pass"})
        page = (self.out / "stress.html").read_text()
        self.assertIn("S12: snap-through", page)
        self.assertNotRegex(page, r'(src|href)="(?!#|data:)')  # one file
        self.assertIn("written to", run.stdout)
        # Whoever wonders about a row can solve its scene.
        solved = coapt("solve", self.out / "scenes" / "S11_knee" / "scene.json", "-o", self.folder / "solved")
        self.assertEqual(solved.returncode, 0, solved.stdout + solved.stderr)

    def test_a_scene_of_ones_own(self):
        run = coapt("stress", self.disc(), "--rows", "S1, S7,S18", "--json", "-o", self.out)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        found = json.loads(run.stdout)
        self.assertEqual(found, json.loads((self.out / "stress.json").read_text()))
        self.assertEqual(found["scene"], "scene.json")
        self.assertEqual({r["id"] for r in found["rows"]}, {"S1", "S7", "S18"})
        self.assertEqual({r["verdict"] for r in found["rows"]}, {"pass"}, run.stdout)
        self.assertFalse((self.out / "scenes").exists())

    def test_stalls_are_no_failure(self):
        scene = self.disc()
        scene.write_text(scene.read_text().replace('"tolerance": 1e-8', '"tolerance": 1e-8, "max_iterations": 2'))
        run = coapt("stress", scene, "--rows", "S1,S22", "--quick", "-o", self.out)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        found = json.loads((self.out / "stress.json").read_text())
        self.assertEqual(found["counts"]["stall"], len(found["rows"]), run.stdout)
        self.assertIn("iteration limit", run.stdout)

    def test_a_row_that_fails_is_told_by_the_exit_code(self):
        # Six sheets of the same triangles take more memory for each of them than one may.
        scene = self.generate("disc", "--triangles", 11000)
        sheet = '{ "type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm" },'
        text = scene.read_text()
        self.assertIn(sheet, text)
        def memory_row():
            run = coapt("stress", scene, "--rows", "S24", "-o", self.out)
            return run, json.loads((self.out / "stress.json").read_text())["rows"][0]

        run, one_sheet = memory_row()
        if one_sheet["verdict"] == "n/a":
            self.skipTest("the system does not tell the size of a process")
        # Sanitizers take more than half of the memory themselves: under them one sheet is too much already.
        self.assertEqual(run.returncode, 0 if one_sheet["figure"] <= one_sheet["limit"] else 1, run.stdout + run.stderr)
        self.assertLess(one_sheet["figure"], 3 * one_sheet["limit"])
        scene.write_text(text.replace(sheet, "".join(
            sheet.replace('"cst_stvk",', f'"cst_stvk", "name": "sheet {k}",') for k in range(6))))
        run, six_sheets = memory_row()
        found = json.loads((self.out / "stress.json").read_text())
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        self.assertEqual(six_sheets["verdict"], "fail")
        self.assertGreater(six_sheets["figure"], max(six_sheets["limit"], one_sheet["figure"]))
        self.assertFalse(found["holds"])
        self.assertFalse(found["cancelled"])
        self.assertIn("1 FAIL", run.stdout)
        self.assertIn("Rows that fail", (self.out / "stress.html").read_text())

    def test_lists_its_rows_and_writes_nothing(self):
        run = coapt("stress", "--list", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        for word in ["S1 ", "S26", "valve with contact", "interrupts"]:
            self.assertIn(word, run.stdout)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_what_was_found_before_an_interrupt_is_written(self):
        with subprocess.Popen([COAPT, "stress", "-o", str(self.out)], stdout=subprocess.PIPE, text=True) as run:
            run.stdout.readline()  # header
            run.stdout.readline()  # first row
            run.send_signal(signal.SIGINT)
            rest = run.stdout.read()
        self.assertEqual(run.returncode, 1, rest)
        found = json.loads((self.out / "stress.json").read_text())
        self.assertTrue(found["cancelled"])
        self.assertFalse(found["holds"])
        self.assertGreaterEqual(len(found["rows"]), 1)

    def test_names_what_cannot_be(self):
        for arguments, words in [(["--rows", "S1,S98"], ["S98", "there are"]), (["--time-limit", "nan"], ["--time-limit"]),
                                 ([self.folder / "none.json"], ["none.json"])]:
            run = coapt("stress", *arguments, "-o", self.out)
            self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
            for word in words:
                self.assertIn(word, run.stderr)
            self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
