"""What was skipped is said in the last lines of a run, with the data that were lacking counted by themselves."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools/skipped_tests.py"
REPORT = """<?xml version="1.0"?>
<testsuite name="ctest" tests="4">
<testcase name="Mesh.Reads" status="run"/>
<testcase name="Mesh.ReadsTheValve" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/>
<system-out>/a/mesh_test.cpp:62: Skipped
skipped: data not found

[  SKIPPED ] Mesh.ReadsTheValve (0 ms)</system-out></testcase>
<testcase name="Newton.WithoutSpectra" status="notrun"><skipped message="x"/>
<system-out>/a/newton_test.cpp:6: Skipped
built with Spectra</system-out></testcase>
<testcase name="page" status="notrun"><skipped message="x"/><system-out></system-out></testcase>
</testsuite>
"""


class SkippedTestsTest(unittest.TestCase):
    def lines(self, report):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "tests.xml"
            file.write_text(report)
            run = subprocess.run([sys.executable, TOOL, file], capture_output=True, text=True, check=True)
        return run.stdout.splitlines()

    def test_the_last_line_counts_them_and_says_how_to_get_the_data(self):
        lines = self.lines(REPORT)
        self.assertEqual(lines[-1], "4 tests, 3 skipped, 1 of them for want of the shared data: docs/testing.md says how to get it")
        self.assertIn("skipped: Newton.WithoutSpectra: built with Spectra", lines)
        self.assertIn("skipped: page: no reason given", lines)

    def test_nothing_skipped_is_one_line(self):
        report = """<testsuite><testcase name="Mesh.Reads" status="run"/></testsuite>"""
        self.assertEqual(self.lines(report), ["1 tests, 0 skipped"])


if __name__ == "__main__":
    unittest.main()
