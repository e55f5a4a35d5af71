"""Pictures of shapes, and figures of convergence and work-precision, by matplotlib (Debian: python3-matplotlib)."""
from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _fields
from ._equilibrium import Equilibrium
from ._errors import InputError
from ._result import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["convergence", "shape", "work_precision"]
_FIELDS = {"displacement": "displacement [mm]", "principal_strain": "greatest principal strain",
           "principal_stress": "greatest second Piola-Kirchhoff stress [MPa]", "cauchy_stress": "greatest Cauchy stress [MPa]",
           "first_piola_stress": "greatest first Piola-Kirchhoff stress [MPa]", "von_mises_stress": "von Mises stress [MPa]",
           "regime": "0 slack, 1 wrinkled, 2 taut", "gap": "gap [mm]", "is_contact": "contact",
           "reference_distance": "distance from the reference [mm]"}
_GREY = "#b8c4d0"
_LABELS = {"iteration": "iteration", "seconds": "wall time [s]", "evaluations": "gradients"}


def _axes(ax: Axes | None) -> Any:
    if ax is not None:
        return ax
    return _matplotlib("pyplot").subplots()[1]


def _matplotlib(module: str) -> Any:
    return _fields.imported(f"matplotlib.{module}", "coapt.plot", "Debian: python3-matplotlib")


def shape(of: Result | Equilibrium, *, color: str | npt.ArrayLike | None = "principal_strain",
          view: tuple[float, float] = (25, -60), lines: bool = True, ax: Axes | None = None) -> Any:
    """The shape, seen from far away: triangles with light and shade, chords and cables as lines.

    Args:
        of: a result, or an equilibrium that is followed.
        color: what its triangles show: the name of one of its `fields`, of which the first of several values counts; numbers
            of one's own for each triangle (m,) or each node (n,); None for grey. A shape without the default's field is grey.
        view: elevation above the plane z = 0 and azimuth of the eye, as matplotlib's 3-D axes count them [degrees];
            (90, -90) looks down, x to the right.
        lines: whether chords and cables are drawn.
        ax: flat axes to draw into; default: those of a new figure.

    Returns:
        The axes; a unit of theirs is a mm.

    Raises:
        InputError: `color` is no field that triangles can show, or has another length.
        ImportError: matplotlib is not installed.
    """
    values, label = _colors(of, color)
    axes = _axes(ax)
    toward, flat = _seen_from(of.x, *view)
    pieces, depths, colors, edges = _triangles(of, flat, toward, _painted(axes, values, label, len(of.faces)))
    for piece in _line_pieces(of, flat) if lines else []:
        pieces.append(piece[:, :2])
        depths.append(piece[:, 2].mean())
        colors.append((0, 0, 0, 0))
        edges.append((0.25, 0.2, 0.15, 1))
    drawn = [k for k in np.argsort(depths) if np.isfinite(depths[k])]  # what is nearer covers what is farther away
    widths = np.where(np.arange(len(pieces)) < len(of.faces), 0.3, 1.2)
    collection = _matplotlib("collections").PolyCollection(
        [pieces[k] for k in drawn], facecolors=[colors[k] for k in drawn], edgecolors=[edges[k] for k in drawn],
        linewidths=widths[drawn], rasterized=len(drawn) > 5000)
    axes.add_collection(collection)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.autoscale_view()
    return axes


def _seen_from(x: npt.NDArray[np.float64], elevation: float, azimuth: float) -> tuple[Any, Any]:
    """The direction towards the eye, and positions to the right, upwards and towards it, (n, 3)."""
    e, a = np.radians(elevation), np.radians(azimuth)
    toward = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right, up = np.array([-np.sin(a), np.cos(a), 0]), np.array([-np.sin(e) * np.cos(a), -np.sin(e) * np.sin(a), np.cos(e)])
    return toward, x @ np.column_stack([right, up, toward])


def _colors(of: Result | Equilibrium, color: str | npt.ArrayLike | None) -> tuple[npt.NDArray[np.float64] | None, str]:
    """A number for each triangle, and what it is."""
    fields = of.fields if isinstance(of, Result) else {}
    label = ""
    if color is None or (isinstance(color, str) and color == "principal_strain" and color not in fields):
        return None, label
    if isinstance(color, str):
        if color not in fields or color not in _FIELDS:
            raise InputError(f"color: is {color!r}; expected one of {', '.join(sorted(fields.keys() & _FIELDS.keys())) or 'none'}"
                             ", or numbers for each triangle or each node")
        values, label = np.asarray(fields[color], dtype=float), _FIELDS[color]
        if color == "displacement":
            values = np.linalg.norm(values, axis=1)
    else:
        values = np.asarray(color, dtype=float)
    values = values[:, 0] if values.ndim == 2 else values
    if values.shape == (len(of.faces),):
        return values, label
    if values.shape not in ((of.x.shape[0],), (of.vertex_count,)):
        raise InputError(f"color: has shape {values.shape}; expected a number for each of {len(of.faces)} triangles or "
                         f"{of.x.shape[0]} nodes")
    mean: npt.NDArray[np.float64] = values[of.faces].mean(axis=1)
    return mean, label


def _painted(axes: Any, values: npt.NDArray[np.float64] | None, label: str, count: int) -> npt.NDArray[np.float64]:
    """A colour of each triangle, (m, 4); the axes get its scale."""
    if values is None:
        return np.tile(_matplotlib("colors").to_rgba(_GREY), (count, 1))
    finite = values[np.isfinite(values)]
    norm = _matplotlib("colors").Normalize(*((finite.min(), finite.max()) if finite.size else (0, 1)))
    scale = _matplotlib("cm").ScalarMappable(norm, "viridis")
    axes.figure.colorbar(scale, ax=axes, label=label, shrink=0.8)
    colors: npt.NDArray[np.float64] = scale.to_rgba(values)
    colors[~np.isfinite(values)] = _matplotlib("colors").to_rgba(_GREY)  # where the field says nothing
    return colors


def _triangles(of: Result | Equilibrium, flat: Any, toward: Any, colors: Any) -> tuple[list[Any], list[Any], list[Any], list[Any]]:
    """Outline, depth and colours of each triangle. Both sides are lit, from above the eye."""
    corners = of.x[of.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    light = (toward + [0, 0, 0.5]) / np.linalg.norm(toward + [0, 0, 0.5])
    lengths = np.linalg.norm(normals, axis=1)
    shade = np.abs(normals @ light) / np.where(lengths > 0, lengths, 1)
    shaded = colors.copy()
    shaded[:, :3] *= (0.5 + 0.5 * np.nan_to_num(shade))[:, None]
    pieces = flat[of.faces]
    return list(pieces[:, :, :2]), list(pieces[:, :, 2].mean(axis=1)), list(shaded), list(shaded)


def _line_pieces(of: Result | Equilibrium, flat: Any, parts: int = 8) -> list[Any]:
    """Short pieces of each line, (2, 3), so that each is in front or behind as a whole."""
    ends = of.lines if isinstance(of, Result) else np.concatenate([np.empty((0, 2), int), *of.lines.values()])
    ticks = np.linspace(0, 1, parts + 1)[:, None]
    points = [flat[a] + ticks * (flat[b] - flat[a]) for a, b in ends]
    return [points_of[k:k + 2] for points_of in points for k in range(parts)]


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
