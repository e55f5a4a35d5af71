"""Figures of convergence and work-precision, by matplotlib (Debian: python3-matplotlib)."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._errors import InputError
from ._result import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LABELS = {"iteration": "iteration", "seconds": "wall time [s]", "evaluations": "gradients"}


def _axes(ax: Axes | None) -> Any:
    if ax is not None:
        return ax
    from matplotlib import pyplot
    return pyplot.subplots()[1]


def convergence(results: Result | Mapping[str, Result], *, against: str = "iteration", ax: Axes | None = None) -> Any:
    """Residual of every accepted iterate.

    Args:
        results: one result, or several by name.
        against: "iteration", "seconds" (wall time) or "evaluations" (of the gradient).
        ax: axes to draw into; default: those of a new figure.

    Returns:
        The axes.

    Raises:
        InputError: `against` is none of these.
    """
    if against not in _LABELS:
        raise InputError(f"against: is {against!r}; expected one of {', '.join(_LABELS)}")
    named = {"": results} if isinstance(results, Result) else results
    axes = _axes(ax)
    for name, result in named.items():
        axes.semilogy(result.history[against], result.history["residual"], marker=".", label=name or None)
    axes.set_xlabel(_LABELS[against])
    axes.set_ylabel("residual")
    if not isinstance(results, Result):
        axes.legend()
    return axes


def work_precision(runs: Mapping[str, Sequence[Result]], *, truth: Result | None = None, ax: Axes | None = None) -> Any:
    """What accuracy costs: one line for each method, a point for each of its runs (to different tolerances).

    Args:
        runs: results by the name of their method.
        truth: a result that counts as exact, such as one of a much smaller tolerance; the error is then the greatest
            distance of a node from it [mm]. Without it the residual stands in its place.
        ax: axes to draw into; default: those of a new figure.

    Returns:
        The axes, wall time [s] over error.

    Raises:
        InputError: a result has other nodes than `truth`.
    """
    axes = _axes(ax)
    for name, results in runs.items():
        errors = [result.residual if truth is None else _distance(result, truth, name) for result in results]
        axes.loglog(errors, [result.seconds for result in results], marker="o", label=name)
    axes.set_xlabel("residual" if truth is None else "greatest distance of a node [mm]")
    axes.set_ylabel("wall time [s]")
    axes.invert_xaxis()
    axes.legend()
    return axes


def _distance(result: Result, truth: Result, name: str) -> float:
    if result.x.shape != truth.x.shape:
        raise InputError(f"runs[{name!r}]: has {result.x.shape[0]} nodes; truth has {truth.x.shape[0]}")
    return float(np.linalg.norm(result.x - truth.x, axis=1).max())
