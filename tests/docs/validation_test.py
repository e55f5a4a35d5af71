"""The validation page names every row of the verification table with a figure, and only files and tests that are there.

    validation_test.py VERIFICATION.md     without that file (it lies beside the sources): the names alone
"""
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = pathlib.Path(sys.argv[1])
PAGE = (ROOT / "docs/validation/README.md").read_text(encoding="utf-8")
ROW = re.compile(r"^\| ([A-Z]\d[\w., ]*?) \|(.*)\|$", re.MULTILINE)


def rows(text: str) -> list[str]:
    return [name for match in ROW.finditer(text) for name in match[1].split(", ")]


class ValidationPage(unittest.TestCase):
    def test_has_every_row_once_and_in_order(self):
        if not TABLE.exists():
            self.skipTest(f"skipped: {TABLE} is not there")
        self.assertEqual(rows(PAGE), rows(TABLE.read_text(encoding="utf-8")))
        self.assertGreater(len(rows(PAGE)), 60)

    def test_names_tests_that_are_there(self):
        count = 0
        for match in ROW.finditer(PAGE):
            file = None
            for name in re.findall(r"`([^`]+)`", match[2].split("|")[1]):
                if name.startswith("tests/") and pathlib.Path(name).suffix:
                    file = ROOT / name
                    self.assertTrue(file.exists(), f"{match[1]}: {name}")
                elif re.fullmatch(r"\w+", name) and file and not name.startswith("fuzz_"):
                    text = file.read_text(encoding="utf-8")
                    self.assertRegex(text, rf"\b{name}\b", f"{match[1]}: {file.name} has no {name}")
                    count += 1
        self.assertGreater(count, 80)

    def test_gives_the_figure_that_every_row_reaches(self):
        for match in ROW.finditer(PAGE):
            cells = [cell.strip() for cell in match[2].split("|")]
            self.assertEqual(len(cells), 3, match[1])
            self.assertTrue(cells[1], match[1])
            figures = re.sub(r"asks for [^;]*", "", cells[2])
            self.assertRegex(figures, r"\d", f"{match[1]}: no figure that is reached, but what the test asks for")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
