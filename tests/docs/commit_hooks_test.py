"""The hooks before a commit check what scripts/test checks without a build, by programs that are there."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENTRIES = re.findall(r"^ +entry: (.*)$", (ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8"), re.MULTILINE)


class CommitHooks(unittest.TestCase):
    def test_run_every_checker_of_the_test_script(self):
        checkers = re.findall(r"^(python3 \S+\.py.*)$", (ROOT / "scripts/test").read_text(encoding="utf-8"),
                              re.MULTILINE)
        self.assertGreaterEqual(len(checkers), 4)
        self.assertLessEqual(set(checkers), set(ENTRIES))

    def test_name_programs_that_are_there(self):
        for entry in ENTRIES:
            self.assertRegex(entry, r"^python3 \S+\.py\b")
            self.assertTrue((ROOT / entry.split()[1]).exists(), entry)


if __name__ == "__main__":
    unittest.main()
