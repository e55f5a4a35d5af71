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
