"""Pages use the field's terms of docs/vocabulary.md: phrases that it gives up do not come back. Decisions, which tell what was
thought at the time, and the reference of the scene file, which the program writes, may keep theirs."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
GIVEN_UP = ("cut into four", "triangle into four", "held dead", "in one pass", "lets nothing through", "through itself at the start", "as far as contact lets",
            "rounds did not settle", "sweeps settle", "judge of intersections", "nonlinear kin", "groundwork")
# Identifiers and words of comments that were renamed.
GIVEN_UP_IN_CODE = ("settle", "Settling", "begin_round", "solve_rounds", "judge_stability", "groundwork", "hold_dead", "Stressed",
                    "HostedRun", "MadeNumber", "sealed_json", "Scenery", "keeps_way", "goes_the_way", "is_on_the_way", "IntersectionJudge",
                    "HeldDead", "renew_reference", "carried_along", "cut_in_four", "write_sealed", "lost_row", "ViewWay", "given_ground")


def sources() -> list[pathlib.Path]:
    return [p for folder in ("src", "bench") for p in (ROOT / folder).rglob("*") if p.suffix in (".cpp", ".hpp")]


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

    def test_the_code_uses_its_words(self):
        self.assertGreater(len(sources()), 300)
        given_up = re.compile(rf"\b({'|'.join(GIVEN_UP_IN_CODE)})")
        for source in sources():
            self.assertIsNone(given_up.search(source.read_text(encoding="utf-8")),
                              f"{source.relative_to(ROOT)}: docs/vocabulary.md has another word")

    def test_no_word_stands_for_two_things(self):
        text = (ROOT / "docs/vocabulary.md").read_text(encoding="utf-8")
        words = re.findall(r"^\| ([^|]+) \|", text.split("## Old words")[0], re.MULTILINE)
        self.assertGreater(len(words), 30)
        self.assertEqual(len(words), len(set(words)))


if __name__ == "__main__":
    unittest.main()
