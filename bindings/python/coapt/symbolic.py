"""What expressions of `coapt.energy` are made of: positions, data, and vector functions that do not expand.

    p, q = coapt.symbolic.nodes(2)                     # where the two nodes of an element are
    k, r = sympy.symbols("k r")                        # data by name
    spring = k / 2 * (coapt.symbolic.norm(q - p) - r) ** 2

Vectors and matrices are SymPy's. SymPy's own `det` and `inv` multiply everything out, which makes derivatives of them
long and slow; those here do not. Needs SymPy (Debian: python3-sympy).
"""
from __future__ import annotations

import importlib
from collections.abc import Callable
from typing import Any

from ._errors import InputError

__all__ = ["array", "columns", "cross", "det", "dot", "gram", "inverse", "nodes", "norm", "trace", "transpose"]


def _sympy(part: str = "sympy") -> Any:
    try:
        return importlib.import_module(part)
    except ImportError as error:
        raise ImportError("energies from expressions need the package SymPy (Debian: python3-sympy)") from error


def _symbol(name: str) -> Any:
    return _sympy().Symbol(name, real=True)


def nodes(count: int, letter: str = "x") -> list[Any]:
    """Positions of the nodes of an element, a SymPy column of three coordinates each [mm].

    Args:
        count: of nodes, as `elements` has columns.
        letter: "x" for where they are, "X" for where the data `X` has them (the reference shape).
    """
    return [array(f"{letter}{node}", 3) for node in range(count)]


def array(name: str, *shape: int) -> Any:
    """Data of one element that are a vector (rows,) or a matrix (rows, columns), as a SymPy matrix."""
    if len(shape) == 1:
        return _sympy().Matrix([_symbol(f"{name}_{row}") for row in range(shape[0])])
    if len(shape) == 2:
        return _sympy().Matrix(*shape, lambda row, column: _symbol(f"{name}_{row}_{column}"))
    raise InputError(f"{name}: has {len(shape)} dimensions; expected a vector or a matrix for each element")


def dot(a: Any, b: Any) -> Any:
    """Scalar product of two vectors."""
    _require_columns("dot", a, b)
    return sum((s * t for s, t in zip(a, b)), _sympy().Integer(0))


def norm(a: Any) -> Any:
    """Length of a vector."""
    return _sympy().sqrt(dot(a, a))


def cross(a: Any, b: Any) -> Any:
    """Vector product of two vectors of three coordinates."""
    _require_columns("cross", a, b, rows=3)
    return _sympy().Matrix([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def columns(*vectors: Any) -> Any:
    """The matrix of these columns."""
    _require_columns("columns", *vectors)
    return _sympy().Matrix.hstack(*vectors)


def gram(*vectors: Any) -> Any:
    """The symmetric matrix of the scalar products of vectors: of the edges of a triangle its metric."""
    _require_columns("gram", *vectors)
    return _sympy().Matrix(len(vectors), len(vectors), lambda i, j: dot(vectors[min(i, j)], vectors[max(i, j)]))


def det(a: Any) -> Any:
    """Determinant of a square matrix."""
    _require_square("det", a)
    return _of_entries(a, lambda entries: entries.det(method="berkowitz"))


def inverse(a: Any) -> Any:
    """Inverse of a square matrix."""
    _require_square("inverse", a)
    return _of_entries(a, lambda entries: entries.adjugate()) / det(a)


def trace(a: Any) -> Any:
    """Sum of the diagonal of a square matrix."""
    _require_square("trace", a)
    return sum((a[k, k] for k in range(a.rows)), _sympy().Integer(0))


def transpose(a: Any) -> Any:
    """The transposed matrix."""
    if not _is_matrix(a):
        raise InputError("transpose: is of a number; expected a matrix")
    return a.T


def _of_entries(a: Any, function: Callable[[Any], Any]) -> Any:
    """A function of a matrix in which its entries stay whole, whatever they are."""
    sympy = _sympy()
    entries = sympy.Matrix(a.rows, a.cols, lambda i, j: sympy.Symbol(f"entry_{i}_{j}"))
    back = {entries[k]: a[k] for k in range(a.rows * a.cols)}
    found = function(entries)
    return found.applyfunc(lambda e: e.xreplace(back)) if _is_matrix(found) else found.xreplace(back)


def _is_matrix(a: Any) -> bool:
    return isinstance(a, _sympy().MatrixBase)


def _require_columns(name: str, *vectors: Any, rows: int | None = None) -> None:
    wanted = f"{rows} coordinates" if rows else "as many coordinates each"
    if not vectors or any(not _is_matrix(a) or a.cols != 1 or a.rows != (rows or vectors[0].rows) for a in vectors):
        raise InputError(f"{name}: expected vectors of {wanted}")


def _require_square(name: str, a: Any) -> None:
    if not _is_matrix(a) or a.rows != a.cols:
        raise InputError(f"{name}: expected a square matrix")
