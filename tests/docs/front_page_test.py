"""The front page stays one: short, with the picture of the closed valve, and the two commands at its top are there."""
import os
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINES = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()


class FrontPage(unittest.TestCase):
    def test_has_at_most_a_hundred_lines(self):
        self.assertLessEqual(len(LINES), 100)

    def test_shows_a_picture_that_loads_at_once(self):
        pictures = re.findall(r"!\[[^\]]+\]\(([^)]+)\)", "\n".join(LINES[:20]))
        self.assertEqual(len(pictures), 1)
        data = (ROOT / pictures[0]).read_bytes()
        self.assertTrue(data.startswith(b"\x89PNG"))
        self.assertLessEqual(len(data), 150_000)

    def test_names_two_commands_at_the_top_that_can_be_run(self):
        commands = [line.split()[0] for line in LINES[:20] if line.startswith("    ")]
        self.assertEqual(commands, ["scripts/demo", "scripts/test"])
        for command in commands:
            self.assertTrue(os.access(ROOT / command, os.X_OK), command)


if __name__ == "__main__":
    unittest.main()
