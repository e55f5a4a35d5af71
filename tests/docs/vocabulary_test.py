"""Pages use the field's terms of docs/vocabulary.md: phrases that it gives up do not come back. Decisions, which tell what was
thought at the time, and the reference of the scene file, which the program writes, may keep theirs."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
GIVEN_UP = ("cut into four", "in one pass", "lets nothing through", "through itself at the start", "as far as contact lets",
            "rounds did not settle", "sweeps settle", "judge of intersections", "nonlinear kin", "groundwork")


def pages() -> list[pathlib.Path]:
    exempt = {ROOT / "docs/vocabulary.md", ROOT / "docs/scene.md"}
    return [p for p in [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "examples").rglob("*.md")]
            if p not in exempt and "decisions" not in p.parts and p.name != "CHANGELOG.md"]


class Vocabulary(unittest.TestCase):
    def test_pages_use_its_words(self):
        self.assertGreater(len(pages()), 20)
        for page in pages():
            text = " ".join(page.read_text(encoding="utf-8").lower().split())
            for phrase in GIVEN_UP:
                self.assertNotIn(phrase, text, f"{page.name}: docs/vocabulary.md has another word")

    def test_no_word_stands_for_two_things(self):
        text = (ROOT / "docs/vocabulary.md").read_text(encoding="utf-8")
        words = re.findall(r"^\| ([^|]+) \|", text.split("## Old words")[0], re.MULTILINE)
        self.assertGreater(len(words), 30)
        self.assertEqual(len(words), len(set(words)))


if __name__ == "__main__":
    unittest.main()
