"""The wheel, installed by pip into an environment that holds nothing of the build, and used there.

    wheel_test.py BUILD SOURCE
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

BUILD, SOURCE = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
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
print(result)
"""


def run(*command, **options) -> str:
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Wheel(unittest.TestCase):
    def test_is_installed_without_a_network_and_solves(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            make = [sys.executable, "-B", SOURCE / "bindings/python/make_wheel.py", BUILD / "python", SOURCE / "LICENSE"]
            wheel = pathlib.Path(run(*make, folder / "one").strip())
            again = pathlib.Path(run(*make, folder / "two").strip())
            self.assertEqual(wheel.read_bytes(), again.read_bytes())
            run(sys.executable, "-m", "venv", "--system-site-packages", folder / "env")
            python = folder / "env/bin/python"
            run(python, "-m", "pip", "install", "--no-index", "--quiet", wheel)
            self.assertIn("converged", run(python, "-c", USE, cwd=folder, env={"PATH": "/usr/bin:/bin"}))
            self.assertIn("coapt/_core.pyi", run(python, "-m", "pip", "show", "--files", "coapt"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
