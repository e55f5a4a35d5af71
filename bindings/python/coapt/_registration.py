"""One surface brought onto another (docs/registration.md)."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arguments, _core
from ._errors import InputError

Array = npt.NDArray[np.float64]
METHODS = ("surface", "annulus", "landmarks")


@dataclass(frozen=True, eq=False)
class Registration:
    """What a registration found, with the names of `registration.json`."""

    V: Array
    """The vertices in their new place, (n, 3) [mm]."""
    method: str
    transform: Array
    """(4, 4), acts on columns (x, y, z, 1) [mm]."""
    scale: float
    angle_deg: float
    translation_mm: float
    """How far the middle of the vertices moved [mm]."""
    rms_mm: float
    """Between the pairs that were kept [mm]."""
    standard_error_mm: float | None
    """Of the places of the points (root mean square), from the noise of the pairs [mm]; by surface only."""
    overlap: float
    """Share of the points with a counterpart close by, 0 to 1."""
    pairs: int
    iterations: int
    free_directions: int
    """Motions that the surfaces do not determine."""
    distances_before: dict[str, dict[str, float]]
    """`to_target` and `from_target`, each `mean_mm`, `p95_mm`, `rms_mm`, `max_mm`."""
    distances_after: dict[str, dict[str, float]]
    coaptation_line: dict[str, dict[str, float]] | None
    """Distance between the coaptation lines after the registration, `to_target` and `from_target`, each `mean_mm`, `p95_mm`,
    `max_mm`; None where the target has no closed boundary loop, or one of the lines is not seen."""
    distance_to_target: Array
    """Of each vertex of V to the target after the registration, (n,) [mm]."""
    distance_from_target: Array
    """Of each vertex of the target, (m,) [mm]."""
    warnings: list[str]


def register(V: npt.ArrayLike, F: npt.ArrayLike, target_V: npt.ArrayLike, target_F: npt.ArrayLike, *,
             method: str | None = None, trim: float = 0.1, scale: bool = False,
             landmarks: tuple[npt.ArrayLike, npt.ArrayLike] | None = None) -> Registration:
    """Brings the surface V, F onto the target without changing its shape, as `coapt register` does.

    Args:
        V, F, target_V, target_F: vertices (n, 3) [mm] and triangles (m, 3) of both surfaces.
        method: "surface" (trimmed closest points, point to plane), "annulus" (closed boundary loops, Hammer et al. 2008)
            or "landmarks" (Umeyama 1991); default: "landmarks" where they are given, else "surface".
        trim: share of the pairs that is left out, the farthest, 0 to 0.9.
        scale: also find one scale.
        landmarks: the same points of both surfaces in the same order, (k, 3) each [mm].

    Raises:
        InputError: input of a wrong shape, or surfaces that nothing believable brings together: no overlap, a mirror
            image, another unit of length. Nothing is moved then.
    """
    defects: list[str] = []
    arrays: list[Any] = []
    for name, vertices, triangles in (("", V, F), ("target_", target_V, target_F)):
        points = _arguments.points(vertices, name + "V", defects)
        count = points.shape[0] if points is not None else 2**31 - 1
        arrays += [points, _arguments.triangles(triangles, name + "F", count, defects)]
    chosen = method or ("landmarks" if landmarks is not None else "surface")
    if chosen not in METHODS:
        defects.append(f"method: is {method!r}; expected one of {', '.join(METHODS)}")
    elif (chosen == "landmarks") != (landmarks is not None):
        defects.append("landmarks: they and method \"landmarks\" need each other")
    if isinstance(trim, bool) or not isinstance(trim, (int, float)) or not 0 <= trim <= 0.9:
        defects.append(f"trim: is {trim!r}; expected a number from 0 to 0.9")
    marks: list[Any] = [None, None]
    if landmarks is not None and not (isinstance(landmarks, (tuple, list)) and len(landmarks) == 2):
        defects.append("landmarks: expected a pair, those of V and those of the target")
    elif landmarks is not None:
        marks = [_arguments.points(of, f"landmarks[{k}]", defects) for k, of in enumerate(landmarks)]
    defects += [f"{name}: holds a number that is not finite"
                for name, of in (("V", arrays[0]), ("target_V", arrays[2]), ("landmarks", marks[0]), ("landmarks", marks[1]))
                if of is not None and not np.isfinite(of).all()]
    if defects:
        raise InputError(*defects)
    return Registration(**_core.register_surface(
        arrays[0], arrays[1], arrays[2], arrays[3], chosen, float(trim), bool(scale), marks[0], marks[1]))
