"""Solving: scenes from files and dicts, and meshes in memory."""
from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy.typing as npt

from . import _arguments, _core, _inputs, _progress
from ._result import Result, result_of

Callback = Callable[[_core.Iterate], Any]


def _checked_options(tol: Any, max_seconds: Any, callback: Any, branches: Any, branch_kick: Any, damped_steps: Any,
                     defects: list[str]) -> None:
    if isinstance(branches, bool) or not isinstance(branches, int) or not 0 <= branches <= 1000:
        defects.append(f"branches: is {branches!r}; expected a number of starts, 0 to 1000")
    if damped_steps is not None and (isinstance(damped_steps, bool) or not isinstance(damped_steps, int)
                                     or not 0 <= damped_steps <= 100000):
        defects.append(f"damped_steps: is {damped_steps!r}; expected a number of steps from 0, which solves at once, "
                       "to 100000")
    _arguments.positive(branch_kick, "branch_kick", "", defects)
    if tol is not None:
        _arguments.positive(tol, "tol", "", defects)
    if max_seconds is not None:
        _arguments.positive(max_seconds, "max_seconds", " [s]", defects)
    if callback is not None and not callable(callback):
        defects.append(f"callback: is a {type(callback).__name__}; expected a function of one argument")


def _run(given: _inputs.Given, *, callback: Callback | None, method: str | None, tol: float | None,
         max_seconds: float | None, modes: int | None, folder: _inputs.Path | None, frames: int | None,
         report: bool | None, branches: int, branch_kick: float, branch_seed: int,
         damped_steps: int | None, progress: bool) -> Result:
    with _progress.shown(callback, progress) as seen:
        return result_of(given.solve(
            _core.run, callback=seen, solver=method or "", tolerance=tol, max_seconds=max_seconds, modes=modes,
            folder=None if folder is None else os.fsencode(folder), frames=frames, page=report,
            branches=branches, branch_kick=branch_kick, branch_seed=branch_seed, damped_steps=damped_steps))


def solve(scene: _inputs.Path | Mapping[str, Any], *, method: str | None = None, tol: float | None = None,
          x0: npt.ArrayLike | None = None, terms: Sequence[Any] = (), callback: Callback | None = None,
          max_seconds: float | None = None, modes: int | None = None, folder: _inputs.Path | None = None,
          frames: int | None = None, report: bool | None = None,
          branches: int = 0, branch_kick: float = 0.01, branch_seed: int = 1,
          damped_steps: int | None = None, progress: bool = False) -> Result:
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
        branches: from how many perturbed starts of each kind, near the equilibrium and from the scene's own start, to
            look for other equilibria once the solve has converged (docs/metrics.md); 0: not at all. With `x0` those
            near the equilibrium alone.
        branch_kick: greatest move of a node of these starts, over the mean edge length.
        branch_seed: of their random moves.
        damped_steps: of all loads and the prescribed motion along a damped path, which defines the equilibrium that a
            valve comes to; 0 solves at once. Default: the scene's `solver.continuation.damped_steps`.
        progress: whether a bar counts the iterates, in a notebook or a terminal; nothing where tqdm is not installed
            (Debian: python3-tqdm).

    Returns:
        A `Result`. A run that does not converge returns one too, with `success` False.

    Raises:
        InputError: anything is wrong with the scene or an argument; it has all defects of one pass.
        KeyboardInterrupt: Ctrl-C.
        Exception: whatever a callback or a term of one's own raised.
    """
    defects: list[str] = []
    _checked_options(tol, max_seconds, callback, branches, branch_kick, damped_steps, defects)
    return _run(_inputs.of_scene(scene, terms, x0, defects), callback=callback, method=method, tol=tol,
                max_seconds=max_seconds, modes=modes, folder=folder, frames=frames, report=report, branches=branches,
                branch_kick=branch_kick, branch_seed=branch_seed, damped_steps=damped_steps, progress=progress)


def minimize(V: npt.ArrayLike, F: npt.ArrayLike, terms: Sequence[Any], *, fixed: Any = None,
             x0: npt.ArrayLike | None = None, method: str | None = None, tol: float | None = None,
             callback: Callback | None = None, regions: Any = None, scene: Mapping[str, Any] | None = None,
             max_seconds: float | None = None, modes: int | None = None, folder: _inputs.Path | None = None,
             frames: int | None = None, report: bool | None = None, branches: int = 0, branch_kick: float = 0.01,
             branch_seed: int = 1, damped_steps: int | None = None, progress: bool = False) -> Result:
    """Finds the equilibrium of a membrane whose mesh is in memory.

    Args:
        V: vertices of the reference shape, (n, 3) [mm]. float64 in C order needs no conversion; the library copies it.
        F: corners of each triangle, (m, 3), counted from 0, counter-clockwise seen from the front. int32 in C order
            needs no conversion; the library copies it.
        terms: energies and loads: dicts with the keys of the scene file ({"type": "cst_stvk", "young": "1 MPa", ...}),
            and energies of one's own (see `Term`), in any order.
        fixed: what is held: node numbers, the name of a set ("boundary"), or true and false of shape (n,) or, for
            single coordinates, (n, 3).
        x0: positions to start from, (n, 3) [mm]; default: V.
        regions: name of each triangle's region, (m,), for terms with the key `region`.
        scene: other keys of the scene file (`boundary`, `sets`, `solver`, `obstacles`, `fibres`, `reference`, ...);
            entries of `boundary` win over `fixed`.
        method, tol, callback, max_seconds, modes, folder, frames, report, branches, branch_kick, branch_seed,
            damped_steps, progress: as in `solve`.

    Returns:
        A `Result`. A run that does not converge returns one too, with `success` False.

    Raises:
        As `solve`.
    """
    defects: list[str] = []
    _checked_options(tol, max_seconds, callback, branches, branch_kick, damped_steps, defects)
    return _run(_inputs.of_mesh(V, F, terms, fixed, x0, regions, scene, defects), callback=callback, method=method,
                tol=tol, max_seconds=max_seconds, modes=modes, folder=folder, frames=frames, report=report,
                branches=branches, branch_kick=branch_kick, branch_seed=branch_seed, damped_steps=damped_steps,
                progress=progress)
