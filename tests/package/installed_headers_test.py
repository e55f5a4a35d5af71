"""What a program sees of an installed library: its headers, their version and language, and flags of its own.

    installed_headers_test.py PREFIX COMPILER VERSION

Proved: no private header is installed, and every one that is finds those that it includes; <coapt/coapt.hpp> names the
language that it needs, and the programs of README.md and docs/library.md are compiled as they stand; pkg-config asks for
Eigen alone; a program whose flags give Eigen another alignment than the library's is refused by the linker.
"""
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PREFIX, COMPILER, VERSION = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
HEADERS = PREFIX / "include/coapt"
ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)


def programs(page: str) -> list[str]:
    return re.findall(r"```cpp\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.DOTALL)


class Headers(unittest.TestCase):
    def setUp(self):
        self.texts = {p.relative_to(HEADERS).as_posix(): p.read_text(encoding="utf-8") for p in HEADERS.rglob("*.hpp")}

    def test_none_is_private(self):
        self.assertGreater(len(self.texts), 50)
        private = [name for name, text in self.texts.items()
                   if "/detail/" in name or "private to this" in text.split("#pragma once")[0].lower()]
        self.assertEqual(private, [])

    def test_each_finds_what_it_includes(self):
        there = set(self.texts) | {f"coapt/{name}" for name in self.texts}
        missing = [f"{name}: {included}" for name, text in self.texts.items() for included in INCLUDE.findall(text)
                   if included not in there and not text.count(f'__has_include("{included}")')
                   and not (name == "coapt.hpp" and "run/run.hpp" not in there)]
        self.assertEqual(missing, [])


@unittest.skipUnless(shutil.which("pkg-config"), "pkg-config is not installed")
class Programs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="coapt-headers-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        pc_files = list(PREFIX.glob("lib*/**/pkgconfig"))
        self.has_scene = any((p / "coapt-scene.pc").exists() for p in pc_files)
        self.environment = os.environ | {"PKG_CONFIG_PATH": ":".join(map(str, pc_files))}

    def pkg_config(self, *arguments: str) -> list[str]:
        return subprocess.run(["pkg-config", *arguments], capture_output=True, text=True, check=True,
                              env=self.environment).stdout.split()

    def compile(self, text: str, *flags: str) -> str:
        """What the compiler and the linker say against it; empty: nothing."""
        source = self.folder / "program.cpp"
        source.write_text(text, encoding="utf-8")
        done = subprocess.run([COMPILER, source, "-o", self.folder / "program", *flags], capture_output=True, text=True)
        return "" if done.returncode == 0 else done.stderr

    def test_the_version_is_known_before_anything_is_compiled(self):
        text = "#include <coapt/version.hpp>\nCOAPT_VERSION_MAJOR COAPT_VERSION_MINOR COAPT_VERSION_PATCH\n"
        done = subprocess.run([COMPILER, "-E", "-P", "-std=c++11", "-x", "c++", "-", *self.pkg_config("--cflags", "coapt")],
                              input=text, capture_output=True, text=True, check=True)
        self.assertEqual(".".join(done.stdout.split()), VERSION)

    def test_an_older_language_is_named_once_and_nothing_else(self):
        said = self.compile("#include <coapt/coapt.hpp>\nint main() {}\n", "-std=c++17", "-fsyntax-only",
                            *self.pkg_config("--cflags", "coapt"))
        self.assertIn("Coapt needs C++20: compile with -std=c++20", said)
        self.assertEqual(said.count("error:"), 1, said)

    def test_the_programs_of_the_pages_are_compiled(self):
        of_page = programs("docs/library.md")
        self.assertEqual([text for text in of_page if "solve_scene(" in text], programs("README.md"))
        for text in of_page:
            with self.subTest(text.splitlines()[0]):
                if "solve_scene(" in text and not self.has_scene:
                    self.skipTest("the library has no scene files")
                self.assertEqual(self.compile(text, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror",
                                              *self.pkg_config("--cflags", "coapt")), "")

    def test_pkg_config_asks_for_eigen_alone(self):
        self.assertEqual(self.pkg_config("--print-requires", "coapt"), ["eigen3"])
        self.assertEqual(self.pkg_config("--print-requires-private", "coapt"), [])

    @unittest.skipUnless(platform.machine() in ("x86_64", "AMD64"), "flags of x86-64")
    def test_flags_that_change_the_alignment_are_refused_by_the_linker(self):
        for header in ("coapt/coapt.hpp", "coapt/energy/objective.hpp"):
            said = [self.compile(f"#include <{header}>\nint main() {{}}\n", "-std=c++20", flag,
                                 *self.pkg_config("--cflags", "--libs", "coapt")) for flag in ("-mno-avx", "-mavx")]
            refused = [text for text in said if text]
            self.assertGreaterEqual(len(refused), 1, header)
            for text in refused:
                self.assertRegex(text, r"undefined .*library_is_built_for_eigen_alignment<\d+, \d+>")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
