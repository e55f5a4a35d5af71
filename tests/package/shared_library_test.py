"""The shared library of an installed tree: its name, what it shows, and that nobody gets two copies of it.

    shared_library_test.py PREFIX PROGRAM CMAKE      PROGRAM is linked to it

Proved: the name that programs ask for has the version of the interface; only names of coapt are shown, so that Eigen, JSON
and the standard library of a program and of the library are apart; a program loads it and needs no archive; CMake refuses
a program that links the archives too.
"""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PREFIX, PROGRAM, CMAKE = pathlib.Path(sys.argv[1]), sys.argv[2], sys.argv[3]
LIBRARY, = PREFIX.glob("lib/**/libcoapt.so")


def run(*command, **options) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True, **options).stdout


class SharedLibrary(unittest.TestCase):
    def test_is_named_after_its_interface(self):
        soname = re.search(r"SONAME.*\[(.*)\]", run("readelf", "-d", LIBRARY))[1]
        self.assertRegex(soname, r"^libcoapt\.so\.\d+\.\d+$")
        self.assertTrue((LIBRARY.parent / soname).exists())
        self.assertNotRegex(run("readelf", "-d", LIBRARY), r"R(UN)?PATH")

    def test_shows_names_of_coapt_alone(self):
        names = [line.split()[-1] for line in run("nm", "-D", "--defined-only", LIBRARY).splitlines()]
        self.assertGreater(len(names), 500)
        self.assertEqual([name for name in names if not re.match(r"_ZG?V?(T.|Thn?\d+_|Tv0_n\d+_)?Z*N+K?5coapt", name)], [])

    def test_a_program_loads_it(self):
        self.assertRegex(run("readelf", "-d", PROGRAM), r"NEEDED.*libcoapt\.so\.")
        self.assertIn("theory", run(PROGRAM))

    def test_a_program_does_not_get_two_copies(self):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder)
            (place / "main.cpp").write_text("int main() {}\n")
            (place / "CMakeLists.txt").write_text(
                "cmake_minimum_required(VERSION 3.25)\nproject(twice LANGUAGES CXX)\nfind_package(coapt REQUIRED COMPONENTS core shared)\n"
                "add_executable(twice main.cpp)\ntarget_link_libraries(twice PRIVATE coapt::core coapt::shared)\n")
            done = subprocess.run([CMAKE, "-S", place, "-B", place / "build", f"-DCMAKE_PREFIX_PATH={PREFIX}"], capture_output=True, text=True)
            self.assertNotEqual(done.returncode, 0)
            self.assertIn("COAPT_LIBRARY", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
