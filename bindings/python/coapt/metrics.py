"""Smooth figures of merit of an `Equilibrium`, with exact derivatives (docs/sensitivities.md).

    orifice = metrics.orifice_area(eq)
    area, gradient = eq.value_and_grad(orifice)

A metric of one's own is any object with `value(x)` -> number and `gradient(x)` -> (n, 3), x being the positions of all
nodes, (n, 3) [mm], read-only. These figures are made for optimisers; those of `solve` are defined in docs/metrics.md.
"""
from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import numpy.typing as npt

from . import _arguments, _core
from ._core import Metric
from ._errors import InputError

if TYPE_CHECKING:
    from ._equilibrium import Equilibrium

Array = npt.NDArray[np.float64]
__all__ = ["Metric", "OwnMetric", "coaptation_area", "coaptation_height", "distance_residuals", "line_force",
           "line_force_norm", "node_position", "orifice_area", "strain_energy", "surface_distance"]


class OwnMetric(Protocol):
    """What a metric written in Python has; it must depend on x alone."""

    def value(self, x: Array) -> float:
        """Its value at x, (n, 3) [mm]."""

    def gradient(self, x: Array) -> Array:
        """Its derivative by x, (n, 3)."""


MetricLike = Metric | OwnMetric


def surface_distance(of: Equilibrium, V: npt.ArrayLike | None = None, F: npt.ArrayLike | None = None, *,
                     rounding: float = 1e-3, sharpness: float = 0.0, name: str = "surface_distance") -> Metric:
    """Distance of the vertices of the mesh from a target surface, unsigned [mm]; vertices weigh their area at rest.

    Args:
        V, F: vertices (n, 3) [mm] and triangles (m, 3) of the target; default: the scene's closed reference surface.
        rounding: a distance d counts as sqrt(d^2 + rounding^2) - rounding [mm].
        sharpness: 0 for the mean; above, the smooth maximum log(mean of exp(sharpness d)) / sharpness [1/mm].
    """
    vertices, triangles = _target(V, F)
    return _core.surface_distance(of._core, name, vertices, triangles, rounding, sharpness)


def distance_residuals(of: Equilibrium, V: npt.ArrayLike | None = None, F: npt.ArrayLike | None = None, *,
                       rounding: float = 1e-3, name: str = "distance") -> list[Metric]:
    """The rounded distance of each vertex by itself, times the root of its share of the area [mm]: residuals for least
    squares, whose squares add up to the mean square distance. Arguments as in `surface_distance`."""
    vertices, triangles = _target(V, F)
    return _core.distance_residuals(of._core, name, vertices, triangles, rounding)


def orifice_area(of: Equilibrium, *, axis: npt.ArrayLike | None = None, blur: float = 1.0,
                 annulus: str | npt.ArrayLike = "annulus", name: str = "orifice_area") -> Metric:
    """What is open within the annulus in the view along an axis, edges blurred [mm2].

    Args:
        axis: of the view, (3,); default: normal to the mean plane of the annulus as it is now.
        blur: radius of the blur [mm]; narrower slits count in part or not at all.
        annulus: nodes of the annulus in order, or the name of their set.
    """
    nodes = _nodes(of, annulus, "annulus")
    return _core.orifice_area(of._core, name, nodes, _axis(of, axis, nodes), blur)


def coaptation_area(of: Equilibrium, *, range: float | None = None, name: str = "coaptation_area") -> Metric:
    """Area of the mesh that lies against another part of it, both faces counted [mm2].

    Args:
        range: distance from which on a vertex does not count [mm]; it counts wholly below half of it. Default: twice
            the range of the scene's contact.
    """
    return _core.coaptation(of._core, name, None, _range(of, range), 2.0)


def coaptation_height(of: Equilibrium, *, axis: npt.ArrayLike | None = None, range: float | None = None,
                      sharpness: float = 2.0, annulus: str | npt.ArrayLike = "annulus",
                      name: str = "coaptation_height") -> Metric:
    """Extent of the zone of coaptation along an axis, smooth maximum minus smooth minimum [mm].

    Args:
        axis: (3,); default: normal to the mean plane of the annulus as it is now.
        range: as in `coaptation_area` [mm].
        sharpness: of the smooth extremes [1/mm].
        annulus: as in `orifice_area`; it counts where no axis is given.
    """
    nodes = [] if axis is not None else _nodes(of, annulus, "annulus")
    return _core.coaptation(of._core, name, _axis(of, axis, nodes), _range(of, range), sharpness)


def line_force(of: Equilibrium, term: str, line: int, *, name: str | None = None) -> Metric:
    """Axial force of one chord or cable [N], 0 of a slack one: a line of `of.lines[term]`, counted from 0."""
    return _core.line_force(of._core, name or f"{term}[{line}]", term, line)


def line_force_norm(of: Equilibrium, term: str, *, lines: Sequence[int] | None = None, exponent: float = 8.0,
                    name: str = "line_force_norm") -> Metric:
    """Smooth greatest axial force, (mean of F^exponent)^(1/exponent), over lines of a term [N]; default: over all."""
    chosen = None if lines is None else [int(line) for line in lines]
    return _core.line_force_norm(of._core, name, term, chosen, exponent)


def strain_energy(of: Equilibrium, *, name: str = "strain_energy") -> Metric:
    """Elastic energy of all terms that are neither load nor contact [mJ]."""
    return _core.strain_energy(of._core, name)


def node_position(of: Equilibrium, nodes: npt.ArrayLike, weights: npt.ArrayLike, *, name: str = "position") -> Metric:
    """sum of weights . x over nodes: a coordinate, a mean place, a distance along a direction [mm times weight].

    Args:
        nodes: their numbers, (k,), or one number.
        weights: (k, 3), or (3,) for all alike.
    """
    numbers = _nodes(of, nodes, "nodes")
    array = _arguments.numbers(weights, "weights", f"real numbers of shape ({len(numbers)}, 3) or (3,)")
    if array.shape not in ((3,), (len(numbers), 3)):
        raise InputError(f"weights: has shape {array.shape}; expected ({len(numbers)}, 3) or (3,)")
    return _core.node_position(of._core, name, numbers, np.array(np.broadcast_to(array, (len(numbers), 3))))


def as_metric(followed: _core.Followed, metric: Any) -> Metric:
    """A metric of the library as it is, one of the caller's with its shapes checked."""
    if isinstance(metric, Metric):
        return metric
    if not (callable(getattr(metric, "value", None)) and callable(getattr(metric, "gradient", None))):
        raise InputError(f"metric: is a {type(metric).__name__}; expected one of coapt.metrics, or an object with "
                         "value(x) and gradient(x)")
    name = str(getattr(metric, "name", type(metric).__name__))
    return _core.user_metric(followed, name, _checked(metric, name))


def _checked(metric: OwnMetric, name: str) -> Callable[[Array, bool], tuple[float, Array | None]]:
    def evaluate(x: Array, wants_gradient: bool) -> tuple[float, Array | None]:
        x.setflags(write=False)
        value = metric.value(x)
        if np.ndim(value) != 0 or not np.isreal(value) or not np.isfinite(value):
            raise InputError(f"metric \"{name}\": value() returned {value!r}; expected a finite number")
        if not wants_gradient:
            return float(value), None
        wanted = f"numbers of shape {x.shape}"
        return float(value), _arguments.numbers(metric.gradient(x), f"metric \"{name}\": gradient()", wanted, x.shape)

    return evaluate


def _target(V: Any, F: Any) -> tuple[Array | None, npt.NDArray[np.int32] | None]:
    if V is None and F is None:
        return None, None
    defects: list[str] = []
    if V is None or F is None:
        raise InputError("V and F: a target surface needs both, vertices (n, 3) [mm] and triangles (m, 3)")
    vertices = _arguments.points(V, "V", defects)
    triangles = None if vertices is None else _arguments.triangles(F, "F", len(vertices), defects)
    if defects:
        raise InputError(*defects)
    return vertices, triangles


def _nodes(of: Equilibrium, nodes: Any, name: str) -> list[int]:
    if isinstance(nodes, str):
        sets = of.sets
        if nodes not in sets:
            raise InputError(f"{name}: there is no set {nodes!r}; the scene has {', '.join(sets) or 'none'}")
        return [int(node) for node in sets[nodes]]
    array = np.atleast_1d(np.asarray(nodes))
    count = of._core.node_count
    if array.dtype.kind not in "iu" or array.ndim != 1:
        raise InputError(f"{name}: has dtype {array.dtype} and shape {array.shape}; expected node numbers, (k,)")
    if array.size and (array.min() < 0 or array.max() >= count):
        raise InputError(f"{name}: holds a node that does not exist; the scene has {count}, counted from 0")
    return [int(node) for node in array]


def _axis(of: Equilibrium, axis: Any, nodes: list[int]) -> Array:
    if axis is not None:
        return _arguments.numbers(axis, "axis", "real numbers of shape (3,)", (3,))
    points = of.x[nodes] if len(nodes) >= 3 else None
    if points is None:
        raise InputError("annulus: has fewer than three nodes; give an axis")
    normal: Array = np.linalg.svd(points - points.mean(axis=0))[2][2]
    return np.ascontiguousarray(normal * np.copysign(1.0, normal[np.abs(normal).argmax()]))


def _range(of: Equilibrium, given: float | None) -> float:
    if given is not None:
        return given
    if of._core.contact_range > 0:
        return 2 * of._core.contact_range
    raise InputError("range: the scene has no contact to take it from; give one [mm]")
