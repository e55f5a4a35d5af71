"""The wheel, installed by pip into an environment that holds nothing of the build, and used there.

    wheel_test.py BUILD SOURCE

As root also in a root that holds nothing but Python, NumPy and the packages that the wheel itself names.
"""
import email
import functools
import os
import pathlib
import shutil
import sys
import tempfile
import unittest
import zipfile

BUILD, SOURCE = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
sys.path.append(str(SOURCE / "tests/package"))
import clean_root
from clean_root import run

GIVEN = ["libc6", "libgcc-s1", "libstdc++6"]  # what every Debian has, so that the wheel does not name it
USE = """
import importlib.metadata, pathlib, sys
import numpy as np, coapt
assert pathlib.Path(coapt.__file__).is_relative_to(sys.prefix), coapt.__file__
assert importlib.metadata.version("coapt") == coapt.__version__
V = np.array([[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0], [5, 5, 0]], float)
F = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
result = coapt.minimize(V, F, [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"},
                               {"type": "load_pressure", "value": "0.1 kPa"}], fixed="boundary")
assert result.success and result.x[4, 2] > 0.5, result
assert coapt.solve(sys.argv[1]).success
print(result)
"""


def files_in(folder: pathlib.Path) -> list[pathlib.Path]:
    return sorted(path.relative_to(folder) for path in folder.rglob("*"))


class Wheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="coapt-wheel-")
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.wheel = cls.make("one")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def make(cls, folder: str) -> pathlib.Path:
        make = [sys.executable, "-B", SOURCE / "bindings/python/make_wheel.py", BUILD / "python", SOURCE / "LICENSE"]
        return pathlib.Path(run(*make, cls.folder / folder).strip())

    def needs(self) -> list[str]:
        with zipfile.ZipFile(self.wheel) as wheel:
            name = next(name for name in wheel.namelist() if name.endswith("/METADATA"))
            return email.message_from_bytes(wheel.read(name)).get_all("Requires-External", [])

    def test_the_same_files_give_the_same_bytes(self):
        self.assertEqual(self.wheel.read_bytes(), self.make("two").read_bytes())

    def environment(self, start, folder: pathlib.Path, inside: pathlib.Path, python: str):
        """Makes it in the folder, which what start() starts knows as inside; returns what starts its Python."""
        shutil.copy(self.wheel, folder)
        shutil.copytree(SOURCE / "examples/02_pressurised_disc", folder / "disc")
        start(python, "-m", "venv", "--system-site-packages", inside / "env")
        return functools.partial(start, inside / "env/bin/python", "-B")

    def assert_installs_and_solves(self, python, inside: pathlib.Path):
        python("-m", "pip", "install", "--no-index", "--quiet", inside / self.wheel.name)
        self.assertIn("converged", python("-c", USE, inside / "disc/scene.json"))
        self.assertIn("coapt/_core.pyi", python("-m", "pip", "show", "--files", "coapt"))

    def test_is_installed_without_a_network_and_solves(self):
        start = functools.partial(run, cwd=self.folder, env={"PATH": "/usr/bin:/bin"})
        self.assert_installs_and_solves(self.environment(start, self.folder, self.folder, sys.executable), self.folder)

    def test_solves_with_what_it_names_and_leaves_nothing(self):
        if os.geteuid() != 0 or sys.base_prefix != "/usr" or not shutil.which("dpkg-shlibdeps"):
            self.skipTest("the wheel among the packages that it names alone: takes root rights for chroot, Debian's "
                          "Python, and dpkg-dev, which tells the names")
        root, inside = self.folder / "root", pathlib.Path("/")
        clean_root.make(root, ", ".join(["python3", "python3-venv", "python3-numpy", *GIVEN, *self.needs()]))
        python = self.environment(functools.partial(clean_root.chroot, root), root, inside, "/usr/bin/python3")
        before = files_in(root / "env")
        self.assert_installs_and_solves(python, inside)
        self.assertIn("No broken requirements", python("-m", "pip", "check"))
        python("-m", "pip", "uninstall", "--quiet", "--yes", "coapt")
        self.assertEqual(files_in(root / "env"), before)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
