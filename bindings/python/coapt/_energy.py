"""Energies from expressions: exact derivatives by SymPy, evaluated by NumPy for all elements at once."""
from __future__ import annotations

import copy
import functools
import itertools
from collections.abc import Callable, Container, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arguments, _derivatives, _expressions, symbolic
from ._errors import InputError
from ._terms import Term

Array = npt.NDArray[np.float64]


def energy(expression: Any, elements: npt.ArrayLike, *, name: str | None = None, role: str = "internal",
           **data: npt.ArrayLike) -> Energy:
    """An energy of one's own from its formula for one element, with exact gradient and Hessian.

        cord = coapt.energy("t * max((norm(x1 - x0) - r) / rho, 0)**3", edges, t=0.2, r=lengths, rho=1)

        membrane = coapt.energy('''G = gram(X1 - X0, X2 - X0)                   # a neo-Hookean, incompressible membrane
                                   g = gram(x1 - x0, x2 - x0)
                                   h * sqrt(det(G)) / 2 * mu / 2 * (trace(inverse(G) * g) + det(G) / det(g) - 3)''',
                                F, X=V, mu=0.33, h=0.8)

    Args:
        expression: the energy of one element [mJ]. A text, in which x0, x1, ... are the positions of its nodes, X0,
            X1, ... those in the data `X`, and every other name is data; or the same in SymPy (see `coapt.symbolic`).
            Functions: sqrt, exp, log, sin, ..., min, max, abs, where(condition, a, b); of vectors and matrices norm,
            dot, cross, gram, columns, det, inverse, trace, transpose. Lines `NAME = ...` may stand before it.
        elements: node numbers of each element, whole numbers of shape (m, k).
        name: unique among the terms; default: "energy", and of the further ones in a list of terms "energy_2", ...
        role: "internal", "load" or "contact", as of `Term`.
        data: by name a number, or numbers for each element: (m,), vectors (m, rows) or matrices (m, rows, columns).
            `X`, the reference positions of all nodes (n, 3) [mm], gives X0, X1, ... of each element.

    Returns:
        A term for `minimize`, `solve` and `Equilibrium`. Where its energy is no finite number the state is not
        admissible. Where an expression has a kink, its derivatives are those of one side.

    Raises:
        InputError: the expression cannot be read, or its names and shapes do not fit the data.
        ImportError: SymPy is not installed.
    """
    return Energy(expression, elements, name=name, role=role, data=data)


class Energy(Term):
    """What `coapt.energy` gives: a term with `value`, `gradient` and `hessian`. It pickles."""

    def __init__(self, expression: Any, elements: npt.ArrayLike, *, name: str | None, role: str,
                 data: Mapping[str, npt.ArrayLike]) -> None:
        self.name, self.role = name or "energy", role
        self._given_name = name
        self._nodes = _element_array(elements)
        self.elements = self._nodes
        self.data = {key: _data_array(key, value, len(self._nodes)) for key, value in data.items()}
        self._written = expression
        self.expression = expression_of(expression, self._nodes.shape[1],
                                        {key: value.shape[1:] for key, value in self.data.items()})
        if "X" in self.data:
            _require_nodes(self._nodes, len(self.data["X"]))
        columns = self._columns()
        self._law = law_of(self.expression, self._nodes.shape[1])
        self._compiled = _compiled(self._law, tuple(symbol for symbol, _ in columns))
        self._fixed = self._compiled.constants([column for _, column in columns])

    def __reduce__(self) -> tuple[Any, ...]:
        return _again, (self._written, self._nodes, self._given_name, self.role, self.data)

    def named_among(self, taken: Container[str]) -> Energy:
        """This term, or one that shares all with it, under a name that is not taken, where the caller gave it none."""
        if self._given_name is not None or self.name not in taken:
            return self
        again = copy.copy(self)
        again.name = next(name for k in itertools.count(2) if (name := f"{self.name}_{k}") not in taken)
        return again

    def __repr__(self) -> str:
        return f"<coapt.Energy {self.name!r}: {len(self._nodes)} elements of {self._nodes.shape[1]} nodes>"

    def element_energies(self, x: npt.ArrayLike) -> Array:
        """Energy of each element at x, (m,) [mJ]."""
        return self._compiled.energies(self._unknowns(np.asarray(x, dtype=np.float64)), self._fixed)

    def value(self, x: Array) -> float:
        """Energy at x, (n, 3) [mJ]; inf where that of an element is no finite number."""
        total = float(self.element_energies(x).sum())
        return total if np.isfinite(total) else np.inf

    def gradient(self, x: Array) -> Array:
        """Its gradient, (n, 3) [N]."""
        forces = self._compiled.gradients(self._unknowns(x), self._fixed)
        return np.stack([np.bincount(self._nodes.ravel(), forces[:, c::3].ravel(), minlength=len(x)) for c in range(3)],
                        axis=1)

    def hessian(self, x: Array) -> Array:
        """Its Hessian, dense blocks (m, 3k, 3k) [N/mm]."""
        return self._compiled.hessians(self._unknowns(x), self._fixed)

    def kernel(self, type_name: str) -> str:
        """A C++ header with this energy as a kernel of the library, a struct of that name (docs/python.md)."""
        from ._kernel import kernel_text
        shapes = {key: value.shape[1:] for key, value in self.data.items()}
        return kernel_text(self.expression, self._nodes.shape[1], shapes, type_name, role=self.role,
                           source=self._written if isinstance(self._written, str) else str(self._written))

    def _unknowns(self, x: Array) -> Array:
        """Values of the variables, (variables, m)."""
        _require_nodes(self._nodes, len(x))
        corners = x[self._nodes]
        if self._law.is_relative:
            corners = corners[:, 1:] - corners[:, :1]
        return np.ascontiguousarray(corners.reshape(len(self._nodes), -1).T)

    def _columns(self) -> list[tuple[Any, Array]]:
        """Symbols of the data, and the value of each: a number or (m,)."""
        columns: list[tuple[Any, Array]] = []
        for key, value in self.data.items():
            if key == "X":
                columns += [(symbol, value[self._nodes[:, node], c])
                            for node, x in enumerate(symbolic.nodes(self._nodes.shape[1], "X")) for c, symbol in enumerate(x)]
            elif value.ndim < 2:
                columns.append((symbolic._symbol(key), value))
            else:
                flat = value.reshape(len(value), -1)
                columns += [(symbol, flat[:, k]) for k, symbol in enumerate(symbolic.array(key, *value.shape[1:]))]
        return columns


def _again(expression: Any, elements: Any, name: str | None, role: str, data: Mapping[str, Any]) -> Energy:
    return Energy(expression, elements, name=name, role=role, data=data)


def expression_of(written: Any, nodes: int, shapes: Mapping[str, tuple[int, ...]]) -> Any:
    """The energy of one element in SymPy, checked. shapes: of each data of one element, () for a number.

    Raises:
        InputError: as `energy`.
    """
    sympy = symbolic._sympy()
    names = names_of(nodes, shapes)
    found = _expressions.parsed(written, names) if isinstance(written, str) else sympy.sympify(written)
    if symbolic._is_matrix(found) or not isinstance(found, sympy.Expr):
        raise InputError(f"expression: is {'a vector or a matrix' if symbolic._is_matrix(found) else 'no energy'}; "
                         "expected one number for an element")
    known = {s.name: s for value in names.values() for s in (value if symbolic._is_matrix(value) else [value])}
    unknown = sorted({s.name for s in found.free_symbols} - known.keys())
    if unknown:
        raise InputError(*(f"expression: {name!r} is not known; give data as {name}=..., or take positions from "
                           f"coapt.symbolic.nodes({nodes})" for name in unknown))
    if found.atoms(sympy.core.function.AppliedUndef):
        raise InputError("expression: holds a function without a formula")
    return found.xreplace({s: known[s.name] for s in found.free_symbols})


def names_of(nodes: int, shapes: Mapping[str, tuple[int, ...]]) -> dict[str, Any]:
    """What stands for positions and data in an expression, by name."""
    names = {f"x{node}": x for node, x in enumerate(symbolic.nodes(nodes))}
    if "X" in shapes:
        names |= {f"X{node}": x for node, x in enumerate(symbolic.nodes(nodes, "X"))}
    taken = {symbol.name for x in names.values() for symbol in x}
    for key, shape in shapes.items():
        if key == "X":
            continue
        if not key.isidentifier() or key.startswith("_") or key.endswith("_"):
            raise InputError(f"{key!r}: is no name for data; expected letters, digits and underscores, none at its ends")
        found = symbolic.array(key, *shape) if shape else symbolic._symbol(key)
        symbols = {symbol.name for symbol in (found if shape else [found])}
        if key in names or key in _expressions.WORDS or symbols & taken:
            raise InputError(f"{key}: has a meaning in expressions; take another name for this data")
        names[key] = found
        taken |= symbols
    return names


def _element_array(elements: npt.ArrayLike) -> npt.NDArray[np.int64]:
    array = np.asarray(elements)
    if array.ndim != 2 or array.shape[1] < 1 or array.dtype.kind not in "iu" or (array.size and array.min() < 0):
        raise InputError(f"elements: has shape {array.shape} of {array.dtype}; expected whole numbers of shape (m, k), the "
                         "nodes of each element counted from 0")
    return np.array(array, dtype=np.int64)


def _require_nodes(elements: npt.NDArray[np.int64], nodes: int) -> None:
    if elements.size and elements.max() >= nodes:
        raise InputError(f"elements: node {elements.max()} does not exist; there are {nodes}, counted from 0")


def _data_array(name: str, value: npt.ArrayLike, elements: int) -> Array:
    if name == "X":
        defects: list[str] = []
        points = _arguments.points(value, "X", defects)
        if points is None:
            raise InputError(*defects)
        return np.array(points)
    wanted = f"a number, or real numbers of shape ({elements}, ...), those of each element"
    array = _arguments.numbers(value, name, wanted) if np.ndim(value) else _arguments.numbers(value, name, wanted, ())
    if array.ndim and (array.shape[0] != elements or array.ndim > 3):
        raise InputError(f"{name}: has shape {array.shape}; expected {wanted}")
    return array


law_of = functools.lru_cache(_derivatives.element_law)


class _Compiled:
    """NumPy functions of a law: they take the variables, (variables, m), and data and constants."""

    def __init__(self, law: _derivatives.ElementLaw, data: tuple[Any, ...]) -> None:
        names = [symbol for symbol, _ in law.constants]
        self._constants = _function(data, [value for _, value in law.constants]) if names else None
        inputs = [*law.unknowns, *data, *names]
        self._conditions = _function(inputs, [branch.condition for branch in law.branches]) if len(law.branches) > 1 else None
        self._energies = [_function(inputs, [branch.energy]) for branch in law.branches]
        self._gradients = [_function(inputs, branch.gradient) for branch in law.branches]
        self._hessians = [_function(inputs, branch.hessian) for branch in law.branches]
        variables = len(law.unknowns)
        #: derivatives of the variables by the coordinates, and what entries of the upper triangle add to a block
        self._by_coordinates = np.eye(3 * law.nodes)[-variables:]
        if law.is_relative:
            self._by_coordinates[:, :3] = -np.tile(np.eye(3), (law.nodes - 1, 1))
        rows, columns = np.triu_indices(variables)
        blocks = np.einsum("ka,kb->kab", self._by_coordinates[rows], self._by_coordinates[columns])
        blocks[rows != columns] += blocks[rows != columns].swapaxes(1, 2)
        self._by_entries = blocks.reshape(len(rows), -1)

    def constants(self, data: list[Array]) -> list[Any]:
        """Data, and what depends on them alone."""
        with np.errstate(all="ignore"):
            return [*data, *(self._constants(*data) if self._constants else [])]

    def energies(self, unknowns: Array, fixed: list[Any]) -> Array:
        """(m,)."""
        found: Array = self._evaluated(self._energies, 1, unknowns, fixed)[0]
        return found

    def gradients(self, unknowns: Array, fixed: list[Any]) -> Array:
        """(m, 3 nodes)."""
        found: Array = self._evaluated(self._gradients, len(self._by_coordinates), unknowns, fixed).T @ self._by_coordinates
        return found

    def hessians(self, unknowns: Array, fixed: list[Any]) -> Array:
        """(m, 3 nodes, 3 nodes)."""
        size = self._by_coordinates.shape[1]
        found: Array = self._evaluated(self._hessians, len(self._by_entries), unknowns, fixed).T @ self._by_entries
        return found.reshape(-1, size, size)

    def _evaluated(self, functions: list[Callable[..., Any]], rows: int, unknowns: Array, fixed: list[Any]) -> Array:
        """(rows, m); every branch only where it counts."""
        found = np.full((rows, unknowns.shape[1]), np.nan)
        with np.errstate(all="ignore"):  # what is not finite is not admissible
            if self._conditions is None:
                for row, value in enumerate(functions[0](*unknowns, *fixed)):
                    found[row] = value
                return found
            left = np.full(unknowns.shape[1], True)
            for function, condition in zip(functions, self._conditions(*unknowns, *fixed)):
                here = np.flatnonzero(left & condition)
                left[here] = False
                some = [value[here] if np.ndim(value) else value for value in fixed]
                for row, value in enumerate(function(*unknowns[:, here], *some)):
                    found[row, here] = value
        return found


_compiled = functools.lru_cache(_Compiled)


def _function(inputs: Sequence[Any], outputs: list[Any]) -> Callable[..., Any]:
    """A function of numbers and arrays that gives a list."""
    sympy = symbolic._sympy()

    def shared(expressions: list[Any], **_: Any) -> tuple[_derivatives.Assignments, list[Any]]:
        return _derivatives.assignments(expressions, "t")

    printer = _derivatives.power_printer(symbolic._sympy("sympy.printing.numpy").NumPyPrinter)(
        {"fully_qualified_modules": False, "inline": True, "allow_unknown_functions": True})
    powers = {"square": np.square, "cube": lambda a: a * a * a, "fourth": lambda a: np.square(a * a)}
    made: Callable[..., Any] = sympy.lambdify(inputs, outputs, cse=shared, printer=printer, modules=[powers, "numpy"])
    return made
