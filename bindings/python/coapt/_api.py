"""Solving: scenes from files and dicts, and meshes in memory."""
from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy.typing as npt

from . import _arguments, _core
from ._errors import InputError
from ._result import Result, result_of

Callback = Callable[[_core.Iterate], Any]
Path = str | os.PathLike[str]


def _positive(value: Any, name: str, unit: str, defects: list[str]) -> None:
    if value is not None and not (isinstance(value, (int, float)) and value > 0):
        defects.append(f"{name}: is {value!r}; expected a number above 0{unit}")


def _checked_options(tol: Any, max_seconds: Any, callback: Any, defects: list[str]) -> None:
    _positive(tol, "tol", "", defects)
    _positive(max_seconds, "max_seconds", " [s]", defects)
    if callback is not None and not callable(callback):
        defects.append(f"callback: is a {type(callback).__name__}; expected a function of one argument")


def _run(text: str | None, file: str, terms: Sequence[Any], *, start: Any, callback: Callback | None,
         method: str | None, tol: float | None, max_seconds: float | None, modes: int | None, folder: Path | None,
         frames: int | None, report: bool | None, vertices: Any = None, triangles: Any = None,
         regions: tuple[list[int], list[str]] = ([], [])) -> Result:
    return result_of(_core.run(
        text=text, file=os.fsencode(file), vertices=vertices, triangles=triangles, regions=regions[0],
        region_names=regions[1], start=start, terms=list(terms), callback=callback, solver=method or "", tolerance=tol,
        max_seconds=max_seconds, modes=modes, folder=None if folder is None else os.fsencode(folder), frames=frames,
        page=report))


def solve(scene: Path | Mapping[str, Any], *, method: str | None = None, tol: float | None = None,
          x0: npt.ArrayLike | None = None, terms: Sequence[Any] = (), callback: Callback | None = None,
          max_seconds: float | None = None, modes: int | None = None, folder: Path | None = None,
          frames: int | None = None, report: bool | None = None) -> Result:
    """Solves a scene, as `coapt solve` does.

    Args:
        scene: path of a scene file, or the same keys as a dict (docs/scene.md); relative paths in a dict start from the
            working directory. Quantities are texts with units ("120 mmHg").
        method: name of a solver (see `methods()`); default: the scene's.
        tol: on the residual, the greatest out-of-balance force over the greatest load or reaction; default: the scene's.
        x0: positions to start from, (n, 3) for all nodes in the coordinates of the input [mm]; the supports then stand
            where their motion ends. Default: the scene's own start.
        terms: energies of one's own beside those of the scene (see `Term`).
        callback: called with every accepted iterate (`iteration`, `energy` [mJ], `residual`, `seconds`, `x`, ...);
            returning False or raising StopIteration ends the run, which keeps that iterate.
        max_seconds: wall time after which the run ends [s].
        modes: how many smallest eigenvalues the certificate is to hold.
        folder: result folder to write (closed.vtp, result.json, ...); default: nothing is written.
        frames: write every so-many-th iterate as a frame of an animation; needs `folder`.
        report: whether `report.html` is written; default: as the scene says.

    Returns:
        A `Result`. A run that does not converge returns one too, with `success` False.

    Raises:
        InputError: anything is wrong with the scene or an argument; it has all defects of one pass.
        KeyboardInterrupt: Ctrl-C.
        Exception: whatever a callback or a term of one's own raised.
    """
    defects: list[str] = []
    table, own, _ = _arguments.split_terms(terms, defects)
    if table:
        defects.append("terms: holds a dict; in solve() those belong to the scene's key `terms`")
    start = None if x0 is None else _arguments.points(x0, "x0", defects)
    _checked_options(tol, max_seconds, callback, defects)
    is_mapping = isinstance(scene, Mapping)
    if not is_mapping and not isinstance(scene, (str, os.PathLike)):
        defects.append(f"scene: is a {type(scene).__name__}; expected a path or a dict")
    if defects:
        raise InputError(*defects)
    text = _arguments.scene_text(scene) if isinstance(scene, Mapping) else None
    file = "scene" if isinstance(scene, Mapping) else os.fspath(scene)
    return _run(text, file, own, start=start, callback=callback, method=method, tol=tol, max_seconds=max_seconds,
                modes=modes, folder=folder, frames=frames, report=report)


def minimize(V: npt.ArrayLike, F: npt.ArrayLike, terms: Sequence[Any], *, fixed: Any = None,
             x0: npt.ArrayLike | None = None, method: str | None = None, tol: float | None = None,
             callback: Callback | None = None, regions: Any = None, scene: Mapping[str, Any] | None = None,
             max_seconds: float | None = None, modes: int | None = None, folder: Path | None = None,
             frames: int | None = None, report: bool | None = None) -> Result:
    """Finds the equilibrium of a membrane whose mesh is in memory.

    Args:
        V: vertices of the reference shape, (n, 3) [mm]. float64 in C order is read in place.
        F: corners of each triangle, (m, 3), counted from 0, counter-clockwise seen from the front. int32 in C order is
            read in place.
        terms: energies and loads: dicts with the keys of the scene file ({"type": "cst_stvk", "young": "1 MPa", ...}),
            and energies of one's own (see `Term`), in any order.
        fixed: what is held: node numbers, the name of a set ("boundary"), or true and false of shape (n,) or, for
            single coordinates, (n, 3).
        x0: positions to start from, (n, 3) [mm]; default: V.
        regions: name of each triangle's region, (m,), for terms with the key `region`.
        scene: other keys of the scene file (`boundary`, `sets`, `solver`, `obstacles`, `fibres`, `reference`, ...);
            entries of `boundary` win over `fixed`.
        method, tol, callback, max_seconds, modes, folder, frames, report: as in `solve`.

    Returns:
        A `Result`. A run that does not converge returns one too, with `success` False.

    Raises:
        As `solve`.
    """
    defects: list[str] = []
    table, own, places = _arguments.split_terms(terms, defects)
    vertices = _arguments.points(V, "V", defects)
    faces = _arguments.triangles(F, "F", len(vertices), defects) if vertices is not None else None
    named = _arguments.regions(regions, len(faces), defects) if faces is not None else ([], [])
    held = _arguments.supports(fixed, len(vertices), defects) if vertices is not None else []
    start = None if x0 is None else _arguments.points(x0, "x0", defects)
    _checked_options(tol, max_seconds, callback, defects)
    if not table and not own and not defects:
        defects.append("terms: is empty; a membrane needs at least one term")
    others = dict(scene or {}) if scene is None or isinstance(scene, Mapping) else {}
    if scene is not None and not isinstance(scene, Mapping):
        defects.append(f"scene: is a {type(scene).__name__}; expected a dict")
    defects += [f"scene: holds {key!r}, which is an argument of its own" for key in ("mesh", "terms") if key in others]
    boundary = others.get("boundary", [])
    if not isinstance(boundary, (list, tuple)):
        defects.append(f"scene: boundary: is a {type(boundary).__name__}; expected a list")
    if defects:
        raise InputError(*defects)
    text = _arguments.scene_text({**others, "boundary": [*held, *boundary], "terms": table})
    try:
        return _run(text, "scene", own, start=start, callback=callback, method=method, tol=tol,
                    max_seconds=max_seconds, modes=modes, folder=folder, frames=frames, report=report,
                    vertices=vertices, triangles=faces, regions=named)
    except InputError as error:
        raise _arguments.as_written(error, places) from None
