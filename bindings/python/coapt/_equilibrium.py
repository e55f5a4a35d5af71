"""An equilibrium that is followed while parameters change: warm solves and exact sensitivities."""
from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from . import _arguments, _core, _html, _inputs
from ._errors import InputError
from ._inputs import Found, Path
from ._resumption import Place, Source, kept, kept_dict, kept_scene
from ._warm_solve import AnchorCheck, KinkWarning, Switch, WarmSolve, anchor_check, warm_solve
from .metrics import Metric, MetricLike, as_metric

Array = npt.NDArray[np.float64]
_SHAPES = {"positions": (-1, 3), "rest": (-1, 3), "forces": (-1, 3)}


class Equilibrium:
    """The equilibrium of a scene, or of a mesh in memory (`Equilibrium.of`), followed while named parameters change.

        eq = coapt.Equilibrium("scene.json", ["chords.length", "annulus.ring"])
        eq.solve()                                     # judged by the objective's residual
        orifice = coapt.metrics.orifice_area(eq)
        area, slope = eq.value_and_grad(orifice)        # exact, for every number of every parameter
        eq["chords.length"] = 0.95
        eq.solve()                                     # warm: a few Newton steps

    Parameters (TERM and SET are names of the scene; `available` lists all):
        TERM.lengths: rest length of each line of a cable or tether term, (k,) [mm].
        TERM.length: one factor on all of them, (1,).
        GROUP.length: one factor on the chords of one material or of one papillary tip (tip_0, tip_1 ...), (1,).
        TERM.stiffness, TERM.thickness: factor on the moduli or the thickness, (1,).
        TERM.pressure: pressure along the normals, (1,) [MPa].
        TERM.load: one factor on the forces of a load_field or of a frozen load_pressure, (1,).
        TERM.forces: these forces themselves, (k, 3) [N], on the nodes `loads[TERM]`.
        TERM.KEY: any other number of an elastic term by its key, such as `leaflets.poisson`, (1,) (docs/sensitivities.md).
        SET.positions: places of prescribed nodes, (n, 3) [mm].
        SET.shift: one displacement of all of them, (3,) [mm].
        SET.ring: factors on the two widths and the height of the ring through them, and a tilt [rad], (4,).
        SET.rest: places of nodes in the rest shape, (n, 3) [mm].
    Keys of the scene file that `coapt sensitivity` and `coapt study` take are names too: TERM.length_scale for
    TERM.length, and TERM.value for a pressure as the scene has it, against the normals where it acts on the front.
    All numbers of all parameters stand in one vector too, parameter after parameter, coordinates node after node.
    Positions are in the coordinates of the input.

    The interpreter lock is released while it works, and taken for metrics in Python. One object serves one thread at a
    time (another call meanwhile is refused); several objects side by side give the same bits. Ctrl-C ends a solve at
    its next step; `solve()` goes on from there.

    It pickles, with its terms, and so goes to other processes: the copy reads the scene's files again, solves from this
    shape, and stands where this one does, its anchor too. Metrics are made anew for the copy.

    Args:
        scene: path of a scene file, or the same keys as a dict, as in `solve`.
        parameters: their names; more may follow by `add`. No two may change the same data.
        terms: energies of one's own beside those of the scene (see `Term`). Each needs a `hessian`: the steps and the
            derivatives solve with the exact tangent. What they raise ends the call and is raised to the caller.
        x0: positions to start from, (n, 3) for all nodes [mm], as in `solve`; default: the scene's own start.
        tol: of `solve()`, on the residual; the first solve, made here, has the scene's own tolerance.
        method: solver of the first solve; default: the scene's.
        max_seconds: wall time after which a solve ends [s].

    Raises:
        InputError: anything is wrong with the scene, a parameter or an argument; it has all defects of one pass.
        KeyboardInterrupt: Ctrl-C.
        Exception: whatever a term of one's own raised.
    """

    def __init__(self, scene: Path | Mapping[str, Any], parameters: Sequence[str] = (), *, terms: Sequence[Any] = (),
                 x0: npt.ArrayLike | None = None, tol: float = 1e-10, method: str | None = None,
                 max_seconds: float | None = None) -> None:
        defects, names, options = _options(parameters, terms, tol, method, max_seconds)
        given = _inputs.of_scene(scene, terms, x0, defects)
        self._begin(given, names, Source(list(terms), options, kept_scene(scene)))

    @classmethod
    def of(cls, V: npt.ArrayLike, F: npt.ArrayLike, terms: Sequence[Any], parameters: Sequence[str] = (), *,
           fixed: Any = None, x0: npt.ArrayLike | None = None, regions: Any = None,
           scene: Mapping[str, Any] | None = None, tol: float = 1e-10, method: str | None = None,
           max_seconds: float | None = None) -> Self:
        """The equilibrium of a membrane whose mesh is in memory.

            eq = coapt.Equilibrium.of(V, F, [membrane, Foundation(), pressure], ["load_pressure.pressure"],
                                      fixed="boundary")

        Args:
            V: vertices of the reference shape, (n, 3) [mm].
            F: corners of each triangle, (m, 3), counted from 0.
            terms: dicts with the keys of the scene file and energies of one's own, in any order, as in `minimize`; those
                of one's own need a `hessian`.
            parameters: names as in a scene; a term is called by its `name`, or else by its `type`.
            fixed, x0, regions, scene: as in `minimize`. Sets for SET.positions and its like are named in `scene`:
                {"sets": {"rim": [0, 1, 2]}}.
            tol, method, max_seconds: as of the class.

        Raises:
            As the class.
        """
        defects, names, options = _options(parameters, terms, tol, method, max_seconds)
        given = _inputs.of_mesh(V, F, terms, fixed, x0, regions, scene, defects)
        equilibrium = cls.__new__(cls)
        equilibrium._begin(given, names, Source([kept_dict(t) if isinstance(t, Mapping) else t for t in terms], options,
                                                None if scene is None else kept_dict(scene),
                                                (kept(V), kept(F), kept(fixed), kept(regions))))
        return equilibrium

    def _begin(self, given: _inputs.Given, parameters: Sequence[str], source: Source) -> None:
        self._core = given.solve(_core.follow, parameters=list(parameters), **source.options)
        self._source = source
        self._first_x = self._core.x
        self._solved: Place | None = None  # the last shape that was solved
        self._anchor: Place | None = None

    # --- copies elsewhere

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickles the input, the names of the parameters, and where it stands."""
        here = self._solved if self._solved is not None else Place(self._core.value(), self._core.x, is_solved=False)
        return _resumed, (type(self), self._source, self._first_x, self.parameters, self._anchor, here, self._core.value())

    def __repr__(self) -> str:
        return (f"<coapt.Equilibrium: {self._core.node_count} nodes, {len(self.faces)} triangles; parameters "
                f"{', '.join(self.parameters) or 'none'}>")

    def _repr_html_(self) -> str:
        """For notebooks: a picture of the shape (by matplotlib) and the parameters."""
        return _html.of_equilibrium(self)

    # --- parameters

    @property
    def parameters(self) -> list[str]:
        """Names of its parameters, in the order of the vector."""
        return [name for name, _ in self._core.parameters()]

    @property
    def available(self) -> list[str]:
        """Every name that this scene has a parameter for."""
        return self._core.available()

    def add(self, name: str) -> None:
        """One more parameter, behind the others. Raises InputError for a name that is not known or already there, and for
        one that changes what another parameter changes."""
        defects: list[str] = []
        names = _names([name], defects)
        if defects:
            raise InputError(*defects)
        self._core.add(name)
        if self._solved is not None:  # the new numbers are those at which it was solved
            self._solved = Place(np.append(self._solved.value, self._core.value()[self._solved.value.size:]), self._solved.x)
        if self._anchor is not None:
            self._anchor = Place(np.append(self._anchor.value, self._core.value()[self._anchor.value.size:]), self._anchor.x)

    @property
    def value(self) -> Array:
        """All numbers, a vector; a copy. What is assigned counts from the next `solve()` on."""
        return self._core.value()

    @value.setter
    def value(self, numbers: npt.ArrayLike) -> None:
        self._core.set(self._vector(numbers, "value"))

    def __getitem__(self, name: str) -> Array:
        """The numbers of one parameter, in its shape; a copy."""
        where, shape = self._place(name)
        return self.value[where].reshape(shape)

    def __setitem__(self, name: str, numbers: npt.ArrayLike) -> None:
        """One parameter: an array of its shape, or a number for one of size 1."""
        where, shape = self._place(name)
        size = where.stop - where.start
        wanted = tuple(size // 3 if length == -1 else length for length in shape)
        array = _arguments.numbers(numbers, name, f"real numbers of shape {wanted}")
        if array.shape != wanted and not (size == 1 and array.size == 1):
            raise InputError(f"{name}: has shape {array.shape}; expected real numbers of shape {wanted}")
        all_numbers = self.value
        all_numbers[where] = array.ravel()
        self._core.set(all_numbers)

    def split(self, numbers: npt.ArrayLike) -> dict[str, Array]:
        """A vector such as a gradient, cut into the parameters by name, each in its shape."""
        vector = self._vector(numbers, "numbers")
        return {name: vector[where].reshape(shape) for name, where, shape in self._places()}

    # --- solving, and what is there

    def solve(self) -> WarmSolve:
        """Solves for the present parameters, warm: linear prediction, then Newton's method; where that does not
        converge, the whole method. A shape that did not converge is kept, and `success` is False.

        Raises:
            KeyboardInterrupt: Ctrl-C; the shape is where it got to, and solve() goes on from there.
        """
        self._solved = None
        found = warm_solve(self._core.solve())
        self._solved = Place(self._core.value(), self._core.x) if found.success else None
        self._anchor = self._anchor or self._solved
        return found

    def settle(self) -> WarmSolve:
        """The former name of `solve()`, deprecated."""
        warnings.warn("Equilibrium.settle() is now Equilibrium.solve()", DeprecationWarning, stacklevel=2)
        return self.solve()

    def check_anchor(self) -> AnchorCheck:
        """Whether the shape is still on the branch of its anchor, the shape that was solved first: goes from here to
        the anchor's parameters and from there to these, each at once, and compares shapes. Two warm solves; the shape
        is then what it was. `solve()` does it by itself every 20 steps (`WarmSolve.anchor`).

        Raises:
            InputError: the shape is not solved.
        """
        check = anchor_check(self._core.check_anchor())
        assert check is not None
        return check

    def anchor_here(self) -> None:
        """Makes the present shape the anchor.

        Raises:
            InputError: it is not solved.
        """
        self._core.anchor_here()
        self._anchor = self._solved

    @property
    def first(self) -> WarmSolve:
        """How the solve from the scene's own start ended."""
        return warm_solve(self._core.first_solve())

    @property
    def x(self) -> Array:
        """Positions of all nodes, (n, 3) [mm], vertices of the mesh first: those of the last solve, read-only and not
        copied. The array keeps them when others follow."""
        return self._core.x

    @property
    def vertex_count(self) -> int:
        """Number of vertices of the mesh, which are the first nodes."""
        return self._core.vertex_count

    @property
    def faces(self) -> npt.NDArray[np.int32]:
        """Corners of each triangle, (m, 3), read-only."""
        return self._core.faces

    @property
    def lines(self) -> dict[str, npt.NDArray[np.int32]]:
        """Ends of the chords and cables of each term, (k, 2), by its name."""
        return self._core.lines()

    @property
    def loads(self) -> dict[str, npt.NDArray[np.int32]]:
        """Nodes of the forces of each dead load, (k,), by the name of its term: the rows of TERM.forces."""
        return self._core.loads()

    @property
    def sets(self) -> dict[str, npt.NDArray[np.int32]]:
        """Node numbers of each named set."""
        return self._core.sets()

    # --- figures of merit

    def evaluate(self, metric: MetricLike | Sequence[MetricLike]) -> Any:
        """Value of a metric at the present shape, or values of several, (m,); solved or not."""
        values = self._core.evaluate(self._metrics(metric))
        return values if isinstance(metric, (list, tuple)) else float(values[0])

    def value_and_grad(self, metric: MetricLike) -> tuple[float, Array]:
        """Value of a metric and its exact derivative by every number (one linear system for all of them).

        Raises:
            InputError: this shape is not solved, or its tangent is singular.
        """
        return self._told(self._core.value_and_grad(as_metric(self._core, metric)))

    def jacobian(self, metrics: Sequence[MetricLike]) -> Array:
        """Derivatives of several metrics, one row each, (m, numbers)."""
        return self._told(self._core.jacobian(self._metrics(metrics)))

    def weighted_gradient(self, metrics: Sequence[MetricLike], weights: npt.ArrayLike) -> Array:
        """jacobian(metrics).T @ weights by one linear system, (numbers,)."""
        found = self._metrics(metrics)
        array = _arguments.numbers(weights, "weights", f"real numbers of shape ({len(found)},)", (len(found),))
        return self._told(self._core.weighted_gradient(found, array))

    def gauss_newton_product(self, residuals: Sequence[MetricLike], change: npt.ArrayLike) -> Array:
        """J^T J change for residuals of a least-squares problem, by two linear systems, (numbers,)."""
        return self._told(self._core.gauss_newton_product(self._metrics(residuals), self._vector(change, "change")))

    def metric_covariance(self, metrics: Sequence[MetricLike], covariance: npt.ArrayLike) -> Array:
        """First-order covariance of metrics, (m, m), from that of the numbers, (numbers, numbers)."""
        size = self.value.size
        array = _arguments.numbers(covariance, "covariance", f"real numbers of shape ({size}, {size})", (size, size))
        return self._told(self._core.metric_covariance(self._metrics(metrics), array))

    def response(self, change: npt.ArrayLike) -> Array:
        """dx/d(numbers) change: how the nodes move at first order, (n, 3) [mm]."""
        return self._told(self._core.response(self._vector(change, "change")))

    def pull_back(self, weights: npt.ArrayLike) -> Array:
        """Transpose of `response`: derivative by the numbers of a function whose derivative by x is `weights`, (n, 3)."""
        shape = (self._core.node_count, 3)
        array = _arguments.numbers(weights, "weights", f"real numbers of shape {shape}", shape)
        return self._told(self._core.pull_back(array))

    def kinks(self) -> list[Switch]:
        """What stands so near a kink at this shape that rounding decides on which side: what changes its law when the
        shape grows and shrinks by a billionth. Derivatives hold on one side at best there, and whatever gives them
        warns of it (`KinkWarning`).

        Raises:
            InputError: this shape is not solved.
        """
        return [Switch(*each) for each in self._core.kinks()]

    def switches(self, change: npt.ArrayLike) -> list[Switch]:
        """What changes its law between the shapes predicted for -change and +change: where it `is_kink`, derivatives
        jump there. At a kink the list is not empty however small the change."""
        return [Switch(*each) for each in self._core.switches(self._vector(change, "change"))]

    # --- inside

    def _told(self, derivatives: Found) -> Found:
        """The derivatives, after a warning where this shape stands at a kink."""
        kinks = self.kinks()
        if kinks:
            first = kinks[0]
            warnings.warn(f"{first.term}, element {first.element}: stands between {first.before} and {first.after} "
                          f"({len(kinks)} such elements); derivatives hold on one side at best", KinkWarning, stacklevel=3)
        return derivatives

    def _places(self) -> list[tuple[str, slice, tuple[int, ...]]]:
        places: list[tuple[str, slice, tuple[int, ...]]] = []
        first = 0
        for name, size in self._core.parameters():
            places.append((name, slice(first, first + size), _SHAPES.get(name.rpartition(".")[2], (size,))))
            first += size
        return places

    def _place(self, name: str) -> tuple[slice, tuple[int, ...]]:
        for known, where, shape in self._places():
            if known == name:
                return where, shape
        raise InputError(f"{name!r}: is no parameter of this equilibrium, which has {', '.join(self.parameters) or 'none'}"
                         "; name it when the equilibrium is made, or add() it")

    def _vector(self, numbers: npt.ArrayLike, name: str) -> Array:
        size = self._core.value().size
        return _arguments.numbers(numbers, name, f"real numbers of shape ({size},), one for each number of "
                                  f"{', '.join(self.parameters) or 'no parameter'}", (size,))

    def _metrics(self, metrics: MetricLike | Sequence[MetricLike]) -> list[Metric]:
        some = metrics if isinstance(metrics, (list, tuple)) else [metrics]
        return [as_metric(self._core, metric) for metric in some]


def _names(parameters: Any, defects: list[str]) -> list[str]:
    if isinstance(parameters, str) or not isinstance(parameters, Sequence):
        defects.append(f"parameters: is a {type(parameters).__name__}; expected a list of names such as \"chords.length\"")
        return []
    defects += [f"parameters[{k}]: is a {type(name).__name__}; expected a name such as \"chords.length\""
                for k, name in enumerate(parameters) if not isinstance(name, str)]
    return [name for name in parameters if isinstance(name, str)]


def _resumed(kind: type[Equilibrium], source: Source, first_x: Array, parameters: list[str], anchor: Place | None, here: Place,
             value: Array) -> Equilibrium:
    """The equilibrium that was pickled: solved from its first shape, and from its anchor and where it stood."""
    equilibrium = kind.__new__(kind)
    equilibrium._begin(source.given(first_x), parameters, source)
    for place in (anchor, here):
        if place is not None:
            equilibrium._core.resume(np.array(place.value), np.array(place.x))
            if place.is_solved:
                equilibrium.solve()
    if not np.array_equal(value, here.value):
        equilibrium._core.set(np.array(value))
    return equilibrium


def _options(parameters: Any, terms: Any, tol: Any, method: str | None,
             max_seconds: Any) -> tuple[list[str], list[str], dict[str, Any]]:
    """What is wrong so far, names of the parameters, and how the equilibrium is followed."""
    defects: list[str] = []
    names = _names(parameters, defects)
    _arguments.hessians(terms, defects)
    _arguments.positive(tol, "tol", "", defects)
    if max_seconds is not None:
        _arguments.positive(max_seconds, "max_seconds", " [s]", defects)
    return defects, names, {"solver": method or "", "tolerance": tol, "max_seconds": max_seconds}
