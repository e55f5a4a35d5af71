"""What the library itself has: its version of a valve, and what this build holds."""
from __future__ import annotations

import json
import os
import pathlib
from typing import Any, Literal

from . import _core
from ._errors import InputError


def generate_mitral(folder: str | os.PathLike[str], *, triangles: int = 2500, seed: int = 0,
                    preset: Literal["closed", "benchmark"] = "closed") -> pathlib.Path:
    """Writes the generated mitral valve into a folder, as `coapt generate mitral` does; returns the path of its scene.

    Args:
        folder: it is made where it does not exist; files of that name are replaced.
        triangles: wanted number of triangles, at least 100; the mesh has within 5 % of it.
        seed: 0 for the mean valve; any other draws its dimensions from published ranges.
        preset: a valve that closes, or the one that leaks a little, on which tables of the documentation were made.

    Raises:
        InputError: too few triangles, another preset, or a folder that cannot be written.
    """
    defects = [f"{name}: is {value!r}; expected a whole number from {least} to {2**31 - 1}"
               for name, value, least in (("triangles", triangles, 100), ("seed", seed, 0))
               if not isinstance(value, int) or not least <= value < 2**31]
    if defects:
        raise InputError(*defects)
    _core.generate_mitral(folder=os.fsencode(folder), triangles=triangles, seed=seed, preset=preset)
    return pathlib.Path(folder) / "scene.json"


def methods() -> list[str]:
    """Names of the solvers of this build, for `method`."""
    return _core.methods()


def components() -> dict[str, bool]:
    """Optional packages, and whether this build, or coapt-gpl beside it, holds them."""
    return {name: present for name, _, _, present in _core.components()}


def licence() -> str:
    """SPDX expression of this build, with all that it is linked to."""
    return _core.licence()


def scene_schema() -> dict[str, Any]:
    """JSON Schema of the scene file."""
    schema: dict[str, Any] = json.loads(_core.scene_schema())
    return schema
