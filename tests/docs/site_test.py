"""The checkers of the documentation find what is wrong, and what Doxygen is given is what the sources say."""
import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "docs/site")]
import check_links  # noqa: E402
import prepare  # noqa: E402


class Links(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)
        self.addCleanup(setattr, check_links, "ROOT", check_links.ROOT)
        check_links.ROOT = self.root

    def defects(self, text: str) -> list[str]:
        page = self.root / "page.md"
        page.write_text(text, encoding="utf-8")
        return check_links.page_defects(page)

    def test_accepts_what_is_there(self):
        self.assertEqual(self.defects("# A `b` c-d, e\n[x](#a-b-c-d-e) [y](page.md) [z](https://a.b/c)\n"), [])

    def test_numbers_repeated_headings(self):
        self.assertEqual(check_links.headings("# One\n## Two\n```\n# no heading\n```\n## Two\n"), ["one", "two", "two-1"])

    def test_names_missing_files_headings_and_paths(self):
        found = self.defects("# A\n[x](gone.md)\n[y](#b) and `docs/gone.md`\n")
        self.assertEqual(len(found), 3)
        self.assertIn("page.md:2: gone.md", found[0])

    def test_passes_over_code(self):
        self.assertEqual(self.defects("# A\n```\n[x](gone.md)\n```\n\n    [y](gone.md)\n\n`[z](gone.md)`\n"), [])

    def test_follows_the_links_of_a_site(self):
        (self.root / "a.html").write_text('<a href="b.html#x"></a><a href="b.html#y"></a><img src="c.png">')
        (self.root / "b.html").write_text('<p id="x"></p>')
        found = check_links.site_defects(self.root)
        self.assertEqual(len(found), 2, found)

    def test_an_empty_site_is_a_defect(self):
        self.assertEqual(len(check_links.site_defects(self.root)), 1)


class Headers(unittest.TestCase):
    def test_comments_in_front_and_behind_become_documentation(self):
        text = prepare.documented("// The file.\n#pragma once\n\n// Length of x_i <= 2 [mm].\nint a;  // first,\n"
                                  "        // second\nint c; // http\n")
        self.assertIn("/// @file\n/// The file.", text)
        self.assertIn("/// Length of x\\_i \\<= 2 \\[mm\\].", text)
        self.assertIn("int a;  ///< first,\n        ///< second", text)

    def test_a_comment_before_a_blank_line_documents_nothing(self):
        self.assertNotIn("loose", prepare.documented("#pragma once\n// loose\n\nint a;\n"))

    def test_addresses_in_texts_are_no_comments(self):
        line = 'const char* a = "http://b";'
        self.assertEqual(prepare.documented(line), line)

    def test_formulas_keep_their_lines(self):
        text = prepare.documented("#pragma once\n// Energy:\n//   W = a_b\n// of it.\nint a;\n")
        self.assertIn("/// @code{.unparsed}\n///   W = a_b\n/// @endcode\n/// of it.", text)


class Pages(unittest.TestCase):
    def test_links_lead_to_anchors_of_the_site_and_nothing_else_is_a_command(self):
        page = prepare.ROOT / "docs/units.md"
        text = prepare.page_text(page, "# Units @x\n[s](scene.md#mesh) [l](../LICENSE) <b> `<c> @d`\n```\n@e <f>\n```\n")
        self.assertIn("# Units \\@x {#docs-units-page}", text)
        self.assertIn("[s](@ref docs-scene-mesh) l (<tt>LICENSE</tt>) \\<b> `<c> @d`", text)
        self.assertIn("```\n@e <f>\n```", text)


if __name__ == "__main__":
    unittest.main()
