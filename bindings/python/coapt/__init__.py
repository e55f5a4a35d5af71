"""Coapt: closed, loaded equilibria of thin membranes (heart valves) by energy minimisation.

    import coapt
    result = coapt.solve("scene.json", tol=1e-8)      # a scene file, or its keys as a dict
    result.x, result.metrics["orifice_area_mm2"]

    result = coapt.minimize(V, F, [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"},
                                   {"type": "load_pressure", "value": "0.1 kPa"}], fixed="boundary")

Lengths are mm, forces N, stresses MPa, energies mJ. Arrays of points have shape (n, 3).
"""
from __future__ import annotations

import json
from typing import Any

from . import _core
from ._api import minimize, solve
from ._core import Iterate
from ._errors import InputError
from ._result import Result, Status
from ._terms import Term, check_term

__version__ = _core.version()
__all__ = ["InputError", "Iterate", "Result", "Status", "Term", "check_term", "components", "licence", "methods",
           "minimize", "scene_schema", "solve"]


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
