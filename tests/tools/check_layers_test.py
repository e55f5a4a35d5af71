"""check_layers.py fails on each kind of violation, made in a copy of the sources."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


class Layers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        shutil.copytree(ROOT / "src", self.root / "src")
        (self.root / "tools").mkdir()
        shutil.copy(ROOT / "tools/layers.toml", self.root / "tools")

    def run_checker(self) -> tuple[int, list[str]]:
        run = subprocess.run([sys.executable, "-B", str(ROOT / "tools/check_layers.py"), str(self.root)],
                             capture_output=True, text=True)
        return run.returncode, run.stdout.splitlines()

    def expect_defect(self, *words: str):
        """Just one, and it names what is wrong."""
        code, lines = self.run_checker()
        self.assertEqual(code, 1, lines)
        self.assertEqual(len(lines), 1, lines)
        for word in words:
            self.assertIn(word, lines[0])

    def write(self, name: str, text: str):
        path = self.root / "src" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def replace(self, before: str, after: str):
        path = self.root / "tools/layers.toml"
        text = path.read_text(encoding="utf-8")
        self.assertIn(before, text)
        path.write_text(text.replace(before, after, 1), encoding="utf-8")

    def test_accepts_the_sources_as_they_are(self):
        self.assertEqual(self.run_checker(), (0, ["layers: in order"]))

    def test_refuses_an_include_that_the_table_does_not_allow(self):
        self.write("mesh/added.cpp", '#include "energy/term.hpp"\n')
        self.expect_defect("mesh/added.cpp", "energy/term.hpp", "mesh may not include energy")

    def test_refuses_it_in_angle_brackets_too(self):
        self.write("mesh/added.cpp", "#include <energy/term.hpp>\n")
        self.expect_defect("mesh/added.cpp", "mesh may not include energy")

    def test_refuses_a_header_in_the_detail_of_another_room(self):
        self.write("run/added.cpp", '#include "report/detail/page_plot.hpp"\n')
        self.expect_defect("run/added.cpp", "private to report")

    def test_refuses_a_header_that_calls_itself_private_to_another_room(self):
        self.write("scene/added.hpp", "// Numbers. Private to this room.\n#pragma once\n")
        self.write("scene/user.cpp", '#include "scene/added.hpp"\n')
        self.assertEqual(self.run_checker()[0], 0)
        self.write("cli/user.cpp", '#include "scene/added.hpp"\n')
        self.expect_defect("cli/user.cpp", "private to scene")

    def test_refuses_a_comparison_of_the_types_of_terms_outside_their_registry(self):
        for compared in ['term.type == "cst_stvk"', 'term->type() != "load_pressure"', 'term.type.starts_with("cst_")',
                         "term->type() == SurfaceTension::kType"]:
            self.write("results/added.cpp", f"bool is_it(const TermSpec& term) {{ return {compared}; }}\n")
            self.expect_defect("results/added.cpp", "type of a term", "registry")
        self.write("results/added.cpp", 'bool is_it(const Markup& markup) { return markup.type == "Plane"; }\n')
        self.assertEqual(self.run_checker()[0], 0)

    def test_refuses_more_dynamic_casts_than_three(self):
        self.write("results/added.cpp", "auto* film = dynamic_cast<Film*>(&term);\n")
        self.expect_defect("more than 3 dynamic casts", "results/added.cpp")

    def test_refuses_an_include_that_is_not_from_the_root_of_src(self):
        self.write("mesh/added.cpp", '#include "seams.hpp"\n')
        self.expect_defect("mesh/added.cpp", "from the src root")

    def test_refuses_a_circle_of_files(self):
        self.write("core/one.hpp", '#include "core/two.hpp"\n')
        self.write("core/two.hpp", '#include "core/one.hpp"\n')
        self.expect_defect("circle", "core/one.hpp -> core/two.hpp -> core/one.hpp")

    def test_refuses_a_circle_in_the_table(self):
        self.write("mesh/added.cpp", '#include "energy/term.hpp"\n')
        self.replace('"mesh" = ["core"]', '"mesh" = ["core", "energy"]')
        self.expect_defect("circle", "mesh -> energy -> mesh")

    def test_refuses_an_exception_that_is_no_longer_needed(self):
        self.replace("includes = [\n", 'includes = [\n  "mesh/seams.cpp -> formats/text.hpp",\n')
        self.expect_defect("mesh/seams.cpp -> formats/text.hpp", "needed no more")

    def test_refuses_a_permission_that_no_file_uses(self):
        self.replace('"energy/laws" = []', '"energy/laws" = ["core"]')
        self.expect_defect("no file of energy/laws includes core")

    def test_refuses_a_folder_without_a_line_and_a_line_without_a_folder(self):
        self.write("added/one.cpp", "")
        self.expect_defect("src/added", "no line")
        self.replace('"core" = []\n', '"core" = []\n"added" = []\n"gone" = []\n')
        self.expect_defect("src/gone", "no folder")

    def test_refuses_a_library_in_a_public_header(self):
        self.write("mesh/added.hpp", "#pragma once\n#include <nlohmann/json.hpp>\n")
        self.replace('"nlohmann/" = [', '"nlohmann/" = ["mesh/added.hpp", ')
        self.assertEqual(self.run_checker()[0], 0, "not installed")
        self.write("mesh/added/CMakeLists.txt", "coapt_room(mesh HEADERS ../added.hpp SOURCES added.cpp)\n")
        self.expect_defect("mesh/added.hpp", "<nlohmann/json.hpp>")

    def test_refuses_a_library_that_has_a_door_elsewhere(self):
        self.write("cli/added.cpp", "#include <nlohmann/json_fwd.hpp>\n")
        self.expect_defect("cli/added.cpp", "formats/json/json_text.hpp")
        self.write("cli/added.cpp", "")
        self.replace('"CLI/" = [', '"CLI/" = ["cli/main.cpp", ')
        self.expect_defect("cli/main.cpp", "no door")

    def test_refuses_a_header_that_is_not_installed_in_one_that_is(self):
        self.write("mesh/added.hpp", '#pragma once\n#include "mesh/inner.hpp"\n')
        self.write("mesh/inner.hpp", "#pragma once\n")
        self.write("mesh/added/CMakeLists.txt", "coapt_room(mesh HEADERS ../added.hpp SOURCES added.cpp)\n")
        self.expect_defect("mesh/added.hpp", "mesh/inner.hpp", "not installed")


if __name__ == "__main__":
    unittest.main()
