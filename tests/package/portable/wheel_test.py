"""The portable wheel, installed by pip beside Python and NumPy and nothing else.

    wheel_test.py BUILD CPACK

Proved: its tag is that of the C library that the module asks for; it is small, says its licence and hands on the notices
of what is linked in; in a root of Python, pip and NumPy (as root) it is installed without a network, generates and closes
the valve of the quick start, and leaves nothing behind.
"""
import pathlib
import shutil
import sys
import tempfile
import unittest
import zipfile

import portable_build
from portable_build import BUILD, IS_ROOT, LIMIT, NEWEST_GLIBC, NOT_ROOT, SOURCE

import clean_root
import portability

CLOSE = """
import sys, coapt
scene = coapt.generate_mitral(sys.argv[1], triangles=2500)
result = coapt.solve(scene, folder=sys.argv[1] + "/result")
print(coapt.__file__, coapt.licence(), result)
"""


class PortableWheel(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="coapt-portable-wheel-")
        cls.folder = pathlib.Path(cls.temporary.name)
        make = [sys.executable, "-B", SOURCE / "bindings/python/make_wheel.py", BUILD / "python", SOURCE / "LICENSE", cls.folder,
                "--manylinux", NEWEST_GLIBC, "--notices", BUILD / "notices"]
        cls.wheel = pathlib.Path(clean_root.run(*make).strip())

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def text(self, ending: str) -> str:
        with zipfile.ZipFile(self.wheel) as wheel:
            name, = (name for name in wheel.namelist() if name.endswith(ending))
            return wheel.read(name).decode()

    def test_is_small_and_permissive(self):
        self.assertLess(self.wheel.stat().st_size, LIMIT)
        self.assertIn("\nLicense: BSD-3-Clause\n", self.text("/METADATA"))
        self.assertNotIn("Requires-External", self.text("/METADATA"))
        self.assertIn("Redistribution", self.text("/LICENSE"))
        self.assertIn("MPL-2", self.text("/licenses/libeigen3-dev"))

    def test_its_tag_is_that_of_its_c_library(self):
        module, = (BUILD / "python/coapt").glob("*.so")
        major, minor = portability.glibc(module)
        self.assertLessEqual((major, minor), (2, 35))
        self.assertIn(f"-manylinux_{major}_{minor}_", self.wheel.name)
        self.assertIn(f"-manylinux_{major}_{minor}_", self.text("/WHEEL"))
        for name in portability.needed(module):
            self.assertRegex(name, portability.OF_THE_SYSTEM)

    @unittest.skipUnless(IS_ROOT, NOT_ROOT)
    def test_closes_the_valve_of_the_quick_start_beside_numpy(self):
        root = self.folder / "root"
        clean_root.make(root, "python3, python3-venv, python3-numpy")
        shutil.copy(self.wheel, root)
        clean_root.chroot(root, "/usr/bin/python3", "-m", "venv", "--system-site-packages", "/env")
        before = sorted((root / "env").rglob("*"))
        python = lambda *words: clean_root.chroot(root, "/env/bin/python", "-B", *words)
        python("-m", "pip", "install", "--no-index", "--quiet", f"/{self.wheel.name}")
        self.assertIn("No broken requirements", python("-m", "pip", "check"))
        self.assertRegex(python("-c", CLOSE, "/mitral"), "^/env/.* BSD-3-Clause .*converged")
        portable_build.assert_closed(self, root / "mitral/result/result.json")
        python("-m", "pip", "uninstall", "--quiet", "--yes", "coapt")
        self.assertEqual(sorted((root / "env").rglob("*")), before)


if __name__ == "__main__":
    unittest.main(argv=["wheel_test.py"], verbosity=2)
