"""The counts of libFuzzer's runs: each target's own number, the sum over runs, and a target without one is an error."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "fuzz_executions.py"
sys.path.insert(0, str(TOOL.parent))
from fuzz_executions import executions, record  # noqa: E402

LOG = """Start testing: Nov 26 13:00 UTC
1/2 Testing: fuzz_mesh
Output:
#2 INITED cov: 10
stat::number_of_executed_units: 1234
stat::average_exec_per_sec:     10
Test Passed.
2/2 Testing: fuzz_scene
Output:
stat::number_of_executed_units: 66
Test Passed.
"""
CRASHED = LOG.replace("stat::number_of_executed_units: 66", "ERROR: AddressSanitizer")


class FuzzExecutions(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.log = pathlib.Path(self.folder.name) / "log"
        self.table = pathlib.Path(self.folder.name) / "executions.csv"

    def run_tool(self, log):
        self.log.write_text(log, encoding="utf-8")
        return subprocess.run([sys.executable, TOOL, self.log, self.table], capture_output=True, text=True, check=False)

    def test_each_target_has_its_own_number(self):
        self.assertEqual(executions(LOG), {"fuzz_mesh": 1234, "fuzz_scene": 66})
        self.assertEqual(executions(CRASHED), {"fuzz_mesh": 1234, "fuzz_scene": None})

    def test_runs_add_up_in_the_table(self):
        self.assertIn("1300 executions in this run, 1300 in all", self.run_tool(LOG).stdout)
        second = self.run_tool(LOG)
        self.assertEqual(second.returncode, 0, second.stderr)
        self.assertIn("1300 executions in this run, 2600 in all", second.stdout)
        self.assertEqual(len(self.table.read_text(encoding="utf-8").splitlines()), 5)

    def test_a_target_without_a_number_is_named_and_an_error(self):
        run = self.run_tool(CRASHED)
        self.assertEqual(run.returncode, 1)
        self.assertIn("fuzz_scene: no count", run.stdout)
        self.assertEqual(self.run_tool("nothing ran").returncode, 1)

    def test_what_is_recorded_stands_on_the_page_once(self):
        folder = pathlib.Path(self.folder.name)
        kept, page = folder / "kept.csv", folder / "page.md"
        page.write_text("before\n<!-- executions -->\nold\n<!-- end -->\nafter\n", encoding="utf-8")
        for _ in range(2):
            self.run_tool(LOG)
            record(self.table, "a desk, two cores", kept, page)
            self.assertFalse(self.table.exists())
        text = page.read_text(encoding="utf-8")
        self.assertRegex(text, r"^before\n<!-- executions -->\n(\|.*\n)+<!-- end -->\nafter\n$")
        self.assertRegex(text, r"\| a desk, two cores \| `fuzz_mesh` \| 2,468 \|")
        self.assertIn("| all | | | | 2,600 |", text)
        self.assertNotIn("old", text)


if __name__ == "__main__":
    unittest.main()
