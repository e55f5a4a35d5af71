"""pip builds the wheel from the sources by pyproject.toml, without a network.

    build_backend_test.py BUILD      the portable build, in which nothing is compiled again

Proved: `pip wheel` makes the portable wheel; the archive of sources holds every file under version control and what
describes it, and the backend that is in it makes the same archive of it where there is no version control.
"""
import pathlib
import subprocess
import sys
import tarfile
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[3]
BUILD = pathlib.Path(sys.argv[1]).resolve()


def make_sdist(source: pathlib.Path, output: pathlib.Path) -> set[str]:
    """Names in the archive that the backend of these sources makes, without the folder that they stand in."""
    code = f"import build_backend; print(build_backend.build_sdist({str(output)!r}))"
    done = subprocess.run([sys.executable, "-B", "-c", code], cwd=source / "bindings/python", capture_output=True, text=True, check=True)
    with tarfile.open(output / done.stdout.strip()) as archive:
        archive.extractall(output)
        return {name.split("/", 1)[1] for name in archive.getnames()}


class BuildBackend(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="coapt-backend-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def test_pip_makes_the_portable_wheel(self):
        made = self.folder / "made"
        subprocess.run([sys.executable, "-m", "pip", "wheel", "--quiet", "--no-index", "--no-deps", "--wheel-dir", made,
                        "--config-settings", f"build-dir={BUILD}", SOURCE], check=True)
        wheel, = made.glob("*.whl")
        self.assertRegex(wheel.name, r"^coapt-[\d.]+-cp3\d+-cp3\d+-manylinux_2_\d+_\w+\.whl$")
        self.assertIn(wheel.name, [path.name for path in (BUILD / "wheels").iterdir()])

    def test_the_archive_of_sources_holds_all_that_a_build_reads(self):
        first = make_sdist(SOURCE, self.folder)
        for name in ("pyproject.toml", "PKG-INFO", "CMakePresets.json", "src/CMakeLists.txt", "bindings/python/make_wheel.py"):
            self.assertTrue(name in first, name)
        self.assertFalse([name for name in first if name.startswith("build/")])
        unpacked, = (path for path in self.folder.iterdir() if path.is_dir())
        again = self.folder / "again"
        again.mkdir()
        self.assertEqual(make_sdist(unpacked, again), first)


if __name__ == "__main__":
    unittest.main(argv=["build_backend_test.py"], verbosity=2)
