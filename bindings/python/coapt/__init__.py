"""Coapt: closed, loaded equilibria of thin membranes (heart valves) by energy minimisation.

    import coapt
    result = coapt.solve("scene.json", tol=1e-8)      # a scene file, or its keys as a dict
    result.x, result.metrics["orifice_area_mm2"]

    result = coapt.minimize(V, F, [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"},
                                   {"type": "load_pressure", "value": "0.1 kPa"}], fixed="boundary")

    eq = coapt.Equilibrium("scene.json", ["chords.length"])           # warm solves, exact sensitivities
    eq.solve()
    area, slope = eq.value_and_grad(coapt.metrics.orifice_area(eq))

Lengths are mm, forces N, stresses MPa, energies mJ. Arrays of points have shape (n, 3).
"""
from __future__ import annotations

import json
import os
import pathlib
import warnings
from typing import Any

from . import _core, autograd, metrics, plot, symbolic
from ._api import minimize, solve
from ._core import Iterate
from ._energy import Energy, energy
from ._equilibrium import Equilibrium
from ._errors import InputError
from ._objective import LostBranchWarning, Objective, objective
from ._registration import Registration, register
from ._result import Result, Status
from ._terms import Term, check_term
from ._warm_solve import AnchorCheck, KinkWarning, LostBranch, Switch, WarmSolve

__version__ = _core.version()
__all__ = ["AnchorCheck", "Energy", "Equilibrium", "InputError", "Iterate", "KinkWarning", "LostBranch", "LostBranchWarning",
           "Objective", "Registration", "Result", "Status", "Switch", "Term", "WarmSolve", "autograd", "check_term",
           "components", "energy", "generate_mitral", "licence", "methods", "metrics", "minimize", "objective", "plot", "register",
           "scene_schema", "solve", "symbolic"]


def generate_mitral(folder: str | os.PathLike[str], *, triangles: int = 2500, seed: int = 0) -> pathlib.Path:
    """Writes the generated mitral valve into a folder, as `coapt generate mitral` does; returns the path of its scene.

    Args:
        folder: it is made where it does not exist; files of that name are replaced.
        triangles: wanted number of triangles, at least 100; the mesh has within 5 % of it.
        seed: 0 for the mean valve; any other draws its dimensions from published ranges.

    Raises:
        InputError: too few triangles, or a folder that cannot be written.
    """
    defects = [f"{name}: is {value!r}; expected a whole number from {least} to {2**31 - 1}"
               for name, value, least in (("triangles", triangles, 100), ("seed", seed, 0))
               if not isinstance(value, int) or not least <= value < 2**31]
    if defects:
        raise InputError(*defects)
    _core.generate_mitral(folder=os.fsencode(folder), triangles=triangles, seed=seed)
    return pathlib.Path(folder) / "scene.json"


def __getattr__(name: str) -> Any:
    if name == "Settling":  # the former name, deprecated
        warnings.warn("coapt.Settling is now coapt.WarmSolve", DeprecationWarning, stacklevel=2)
        return WarmSolve
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def methods() -> list[str]:
    """Names of the solvers of this build, for `method`."""
    return _core.methods()


def components() -> dict[str, bool]:
    """Optional packages, and whether this build holds them."""
    return {name: present for name, _, _, present in _core.components()}


def licence() -> str:
    """SPDX expression of this build, with all that it is linked to."""
    return _core.licence()


def scene_schema() -> dict[str, Any]:
    """JSON Schema of the scene file."""
    schema: dict[str, Any] = json.loads(_core.scene_schema())
    return schema
