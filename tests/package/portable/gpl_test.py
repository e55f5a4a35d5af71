"""The wheel coapt-gpl beside the portable one: what it adds, and what is said of it.

    gpl_test.py PORTABLE_BUILD BUILD      BUILD holds the module of coapt-gpl

Proved, in a virtual environment with both wheels and nothing of the builds: the portable module alone has no CHOLMOD and
refuses it; with coapt-gpl a scene is solved by CHOLMOD's factors and judged by CGAL, errors of the scene are still
InputError, and the licence is that of the whole; without it, or with one of another build, coapt works and says so.
"""
import pathlib
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[3]
PORTABLE, BUILD = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
sys.path.insert(0, str(SOURCE / "tests/package"))
from clean_root import run

SOLVE = """
import json, sys, coapt
import numpy as np
V = np.array([[0, 0, 0], [10, 0, 0], [10, 10, 0], [0, 10, 0], [5, 5, 0]], float)
F = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
def solve():
    return coapt.minimize(V, F, [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"},
                                 {"type": "load_pressure", "value": "0.1 kPa"}], fixed="boundary", folder=sys.argv[1],
                          scene={"solver": {"factorisation": "cholmod"}})
"""
REFUSED = SOLVE + """
try: solve()
except coapt.InputError as error: print(coapt.licence(), error)
"""
BOTH = SOLVE + """
result = solve()
assert result.success, result
print("judged by", json.load(open(sys.argv[1] + "/result.json"))["judge"])
held = coapt.components()
assert held["CHOLMOD"] and held["CGAL"] and held["OpenBLAS"] and not held["Ceres"], held
try:
    coapt.solve({"nonsense": 1})
except coapt.InputError as error:
    print("InputError", error)
print(coapt.__file__, "|", coapt.licence(), "|", result)
"""


class Gpl(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="coapt-gpl-")
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.wheels = [cls.make(PORTABLE / "python", "--manylinux", "2.35"), cls.make(BUILD / "python_gpl")]
        run(sys.executable, "-m", "venv", "--system-site-packages", cls.folder / "env")
        cls.python("-m", "pip", "install", "--no-index", "--quiet", cls.wheels[0])

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    @classmethod
    def make(cls, tree: pathlib.Path, *options: str) -> pathlib.Path:
        make = [sys.executable, "-B", SOURCE / "bindings/python/make_wheel.py", tree, SOURCE / "LICENSE", cls.folder]
        return pathlib.Path(run(*make, *options).strip())

    @classmethod
    def python(cls, *words) -> str:
        return run(cls.folder / "env/bin/python", "-B", *words, cwd=cls.folder, env={"PATH": "/usr/bin:/bin"})

    def test_adds_factorisation_and_judge_where_it_is_installed(self):
        refused = self.python("-c", REFUSED, self.folder / "result")
        self.assertRegex(refused, 'BSD-3-Clause .*"cholmod" is not in this build')
        self.python("-m", "pip", "install", "--no-index", "--quiet", self.wheels[1])
        try:
            told = self.python("-W", "error", "-c", BOTH, self.folder / "result")
            self.assertIn("judged by cgal", told)
            self.assertRegex(told, r"\| GPL-3.0-or-later as a whole .*\| .*converged")
            self.assertIn("InputError", told)
            self.assertIn(str(self.folder / "env"), told)
        finally:
            self.python("-m", "pip", "uninstall", "--quiet", "--yes", "coapt-gpl")
        self.assertEqual(self.python("-c", "import coapt; print(coapt.licence())"), "BSD-3-Clause\n")

    def test_one_that_does_not_fit_is_told_and_not_used(self):
        package = self.folder / "coapt_gpl"
        package.mkdir()
        self.addCleanup(package.rename, self.folder / "used")
        for text, reason in (("import missing_library", "missing_library"),
                             ("import ctypes\nmake = ctypes.pythonapi.PyCapsule_New\nmake.restype = ctypes.py_object\n"
                              "make.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_void_p]\n"
                              "adapters = lambda: make(1, b'coapt adapters 0.0.9', None)", "made for \"coapt adapters 0.0.9\"")):
            (package / "__init__.py").write_text(text)
            told = self.python("-c", "import warnings\nwith warnings.catch_warnings(record=True) as told:\n"
                                     "    warnings.simplefilter('always')\n    import coapt\n"
                                     "print(coapt.licence(), *(warning.message for warning in told))")
            self.assertIn("BSD-3-Clause coapt-gpl is installed and not used", told)
            self.assertIn(reason, told)


if __name__ == "__main__":
    unittest.main(argv=["gpl_test.py"], verbosity=2)
