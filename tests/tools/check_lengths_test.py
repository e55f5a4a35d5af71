"""check_lengths.py finds long files and functions, and holds its list of old ones to what is there."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


def function(name: str, lines: int) -> str:
    """With braces in texts and comments, where a count of braces would go wrong."""
    return f"void {name}() {{\n" + '  call("}", \'}\');  // }\n' * (lines - 2) + "}\n"


class Lengths(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "src/room").mkdir(parents=True)
        (self.root / "tools").mkdir()
        self.write_list("", "")

    def write(self, text: str, name: str = "src/room/one.cpp"):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text, encoding="utf-8")

    def write_list(self, files: str, functions: str):
        self.write(f"[files]\n{files}\n[functions]\n{functions}\n", "tools/lengths.toml")

    def run_checker(self, *options: str) -> tuple[int, list[str]]:
        run = subprocess.run([sys.executable, "-B", str(ROOT / "tools/check_lengths.py"), *options, str(self.root)],
                             capture_output=True, text=True)
        return run.returncode, run.stdout.splitlines()

    def expect_defect(self, *words: str):
        code, lines = self.run_checker()
        self.assertEqual((code, len(lines)), (1, 1), lines)
        for word in words:
            self.assertIn(word, lines[0])

    def expect_none(self):
        self.assertEqual(self.run_checker(), (0, ["lengths: as they should be"]))

    def test_accepts_what_is_just_within_the_limits(self):
        self.write(function("first", 60) + "\n" * 340)
        self.expect_none()

    def test_finds_a_long_function_in_unnamed_namespaces_and_classes(self):
        self.write("namespace coapt {\nnamespace {\n" + function("long_one", 61) + "}\n}\n")
        self.expect_defect("src/room/one.cpp: long_one: 61 lines")
        self.write("namespace coapt {\nstruct Solver {\n" + function("run", 61) + "};\n}\n", "src/room/one.cpp")
        self.expect_defect("src/room/one.cpp: Solver::run: 61 lines")

    def test_finds_long_functions_of_headers_templates_and_bindings(self):
        self.write("template <class T>\n" + function("of_header", 61), "src/room/two.hpp")
        self.expect_defect("src/room/two.hpp: of_header: 61 lines")
        (self.root / "src/room/two.hpp").unlink()
        self.write(function("bound", 61), "bindings/python/scene.cpp")
        self.expect_defect("bindings/python/scene.cpp: bound: 61 lines")

    def test_finds_a_long_file(self):
        self.write("\n" * 401)
        self.expect_defect("src/room/one.cpp: 401 lines")

    def test_finds_a_long_python_file_of_the_bindings_alone(self):
        self.write("\n" * 401, "bindings/python/coapt/one.py")
        self.expect_defect("bindings/python/coapt/one.py: 401 lines")
        self.write("\n" * 400, "bindings/python/coapt/one.py")
        self.write("\n" * 501, "bench/one.py")
        self.expect_none()

    def test_allows_tests_five_hundred_lines(self):
        self.write("\n" * 500, "tests/room/one_test.cpp")
        self.expect_none()
        self.write("\n" * 501, "tests/room/one_test.cpp")
        self.expect_defect("tests/room/one_test.cpp: 501 lines")

    def test_finds_a_folder_of_many_files(self):
        for number in range(41):
            self.write("", f"src/room/f{number}.cpp")
        self.expect_defect("src/room: 41 files")

    def test_finds_a_large_room_over_its_folders(self):
        for number in range(22):
            self.write("\n" * 387, f"src/room/{'a' if number % 2 else 'b'}/f{number}.cpp")
        self.expect_defect("src/room: 8514 lines")

    def test_what_is_listed_may_not_grow(self):
        self.write_list('"src/room/one.cpp" = 410', '"src/room/two.cpp: old" = 70')
        self.write("\n" * 410)
        self.write(function("old", 70), "src/room/two.cpp")
        self.expect_none()
        self.write("\n" * 411)
        self.expect_defect("src/room/one.cpp: 411 lines; it had 410")
        self.write("\n" * 410)
        self.write(function("old", 71), "src/room/two.cpp")
        self.expect_defect("old: 71 lines; it had 70")

    def test_what_got_shorter_is_written_into_the_list(self):
        self.write_list('"src/room/one.cpp" = 410', '"src/room/two.cpp: old" = 70')
        self.write("\n" * 405)
        self.write(function("old", 60), "src/room/two.cpp")
        code, lines = self.run_checker()
        self.assertEqual((code, len(lines)), (1, 2), lines)
        self.assertEqual(self.run_checker("--lower")[0], 0)
        self.expect_none()
        self.write("\n" * 406)
        self.expect_defect("it had 405")

    def test_lowering_lets_nothing_new_in(self):
        self.write("\n" * 401)
        self.assertEqual(self.run_checker("--lower")[0], 1)
        self.expect_defect("src/room/one.cpp: 401 lines")


if __name__ == "__main__":
    unittest.main()
