"""scripts/check builds and runs the tests of one room, fails where there are none, and lets clang-tidy see what changed.

    check_room_test.py [BUILD_DIR]     with a build: every room of src has tests in it
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else None
STAND_IN = '#!/bin/sh\necho "$(basename "$0") $*" >> "$LOG"\nexit "$(cat "$CODES/$(basename "$0")" 2>/dev/null || echo 0)"\n'


class CheckRoom(unittest.TestCase):
    """The script in a repository of one room; programs that note how they were called stand in for the real ones."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root, self.programs = pathlib.Path(folder.name) / "work", pathlib.Path(folder.name) / "bin"
        self.programs.mkdir()
        self.write("scripts/check", (ROOT / "scripts/check").read_text(encoding="utf-8"))
        self.write("scripts/tidy", STAND_IN)
        for name in ("cmake", "ctest", "python3", "clang-format", "clang-tidy"):
            self.write(self.programs / name, STAND_IN)
        self.write("build/ci/build.ninja", "")
        self.write(".gitignore", "build\n")
        for name in ("energy/term.cpp", "energy/kernels/cable.hpp", "cli/main.cpp"):
            self.write(f"src/{name}", "int a;\n")
        self.git("init", "-q")
        self.commit()

    def write(self, name: str | pathlib.Path, text: str):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)

    def git(self, *words: str):
        subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b.invalid", *words], cwd=self.root, check=True)

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "--no-verify", "--allow-empty", "-m", "One")

    def check(self, *rooms: str) -> tuple[int, list[str], str]:
        """Exit code, the calls of programs, and what it printed."""
        log = self.programs.parent / "log"
        log.write_text("", encoding="utf-8")
        run = subprocess.run([self.root / "scripts/check", *rooms], capture_output=True, text=True, env={
            **os.environ, "PATH": f"{self.programs}:{os.environ['PATH']}", "LOG": str(log), "CODES": str(self.programs.parent)})
        return run.returncode, log.read_text(encoding="utf-8").splitlines(), run.stdout + run.stderr

    def test_names_the_rooms_where_it_is_given_none(self):
        for rooms in ((), ("",), ("no_room",), ("energy", "cli")):
            code, calls, said = self.check(*rooms)
            self.assertEqual((code, calls), (2, []))
            self.assertIn("cli energy", said)

    def test_builds_and_runs_the_tests_of_the_room(self):
        code, calls, said = self.check("energy")
        self.assertEqual(code, 0, said)
        self.assertIn("cmake --build build/ci --target tests_of_energy", calls)
        self.assertTrue([c for c in calls if c.startswith("ctest") and "-L ^energy$" in c and "--no-tests=error" in c], calls)
        self.assertIn("cmake --build build/ci --target coapt_command", self.check("cli")[1])

    def test_fails_where_a_test_or_clang_tidy_does(self):
        for name in ("ctest", "tidy"):
            self.write(self.programs.parent / name, "8\n")
            self.assertEqual(self.check("energy")[0], 8)
            (self.programs.parent / name).unlink()

    def test_shows_clang_tidy_what_is_not_committed_or_in_the_last_commit(self):
        self.commit()
        self.assertIn("clang-tidy: nothing changed in src/energy", self.check("energy")[2])
        self.write("src/energy/kernels/cable.hpp", "int b;\n")
        self.write("src/cli/main.cpp", "int b;\n")
        self.write("src/energy/new.cpp", "int b;\n")
        self.assertIn("tidy src/energy/kernels/cable.hpp src/energy/new.cpp", self.check("energy")[1])
        self.commit()
        self.assertIn("tidy src/energy/kernels/cable.hpp src/energy/new.cpp", self.check("energy")[1])
        self.commit()
        self.assertFalse([c for c in self.check("energy")[1] if c.startswith("tidy")])

    def test_a_clang_tidy_that_takes_longer_is_no_defect_and_is_said(self):
        self.write(self.programs.parent / "tidy", "124\n")
        code, _, said = self.check("energy")
        self.assertEqual(code, 0)
        self.assertIn("not through in a minute", said)


@unittest.skipUnless(BUILD, "no build is given")
class Rooms(unittest.TestCase):
    def test_each_has_tests_with_its_name_as_label(self):
        for room in sorted(path.name for path in (ROOT / "src").iterdir() if path.is_dir()):
            run = subprocess.run(["ctest", "-N", "-L", f"^{room}$", "-LE", "nightly"], cwd=BUILD, capture_output=True, text=True)
            self.assertNotIn("Total Tests: 0", run.stdout, room)
            self.assertIn("Total Tests:", run.stdout, room)


if __name__ == "__main__":
    unittest.main()
