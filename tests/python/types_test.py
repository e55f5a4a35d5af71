"""Annotations and stubs: mypy accepts the package, and the stubs say what the compiled module holds."""
import os
import pathlib
import subprocess
import sys

import coapt
import pytest
from meshes import ROOT

pytest.importorskip("mypy")


def run(tmp_path, *command):
    folder = pathlib.Path(coapt.__file__).parent.parent
    environment = os.environ | {"MYPYPATH": str(folder), "MYPY_CACHE_DIR": str(tmp_path)}
    done = subprocess.run([sys.executable, "-m", *command], capture_output=True, text=True, env=environment, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


def test_mypy_accepts_the_package(tmp_path):
    run(tmp_path, "mypy", "--strict", "--ignore-missing-imports", "-p", "coapt")


def test_the_stubs_are_those_of_the_module(tmp_path):
    known = tmp_path / "known"  # classes of pybind11 have a metaclass of its own
    known.write_text("".join(f"coapt._core.{name}\n" for name in ("Followed", "Input", "Iterate", "Metric",
                                                                    "Solution")))
    run(tmp_path, "mypy.stubtest", "coapt._core", "--ignore-missing-stub", "--allowlist", str(known))


def test_a_type_checker_knows_results_and_accepts_terms_of_ones_own(tmp_path):
    (tmp_path / "use.py").write_text("""
import numpy as np
import numpy.typing as npt
import coapt

class Foundation(coapt.Term):
    def value(self, x: npt.NDArray[np.float64]) -> float:
        return float((x**2).sum())
    def gradient(self, x: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return 2 * x
    def hessian(self, x: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
        return 2 * np.eye(x.size)

result = coapt.solve("scene.json", terms=[Foundation(), coapt.energy("k * x0[0]", [[0]], k=1)], progress=True)
area: float | None = result.metrics["orifice_area_mm2"]
nodes: list[int] = result.certificate["free_nodes"]
stable: bool = result.certificate["stability"] == "strict_minimum"
if result.branches is not None:
    first: coapt.Metrics = result.branches["equilibria"][0]["metrics"]
coapt.plot.shape(result, color="gap")
""")
    run(tmp_path, "mypy", "--strict", "--ignore-missing-imports", "use.py")
    (tmp_path / "misuse.py").write_text("""
import coapt
result = coapt.solve("scene.json")
result.metrics["orifice_aera_mm2"]
result.certificate["stability"] == "strictly"
text: str = result.metrics["orifice_area_mm2"]
""")
    with pytest.raises(AssertionError) as told:
        run(tmp_path, "mypy", "--strict", "--ignore-missing-imports", "misuse.py")
    for line in (4, 5, 6):
        assert f"misuse.py:{line}: error" in str(told.value)
