"""Energies of the caller's own."""
from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from . import _arguments, _core
from ._errors import InputError

Array = npt.NDArray[np.float64]


class Term:
    """An energy written in Python, to stand beside those of the library.

    Derive from it, or give any object with `value` and `gradient`. Positions `x` have shape (n, 3) [mm] and come for
    all nodes of the scene, the vertices of the mesh first; the array is read-only. It is called for many states in
    any order, so it must depend on `x` alone. What it raises ends the run and is raised to the caller.

    Attributes:
        name: unique among the terms; default: the name of the class.
        role: "internal" for an energy of the body itself, which does not change when the body moves as a whole;
            "load" for what is applied (it sets the force that residuals are measured against); "contact" for what the
            body meets, such as a wall or a foundation.
        elements: nodes of each element, whole numbers of shape (m, k); needed for a Hessian of dense blocks.
        hessian: None, or a function of x. Without it only methods that need no second derivatives take the term
            ("lbfgs", "bfgs", ...), and the result has no certificate. It returns either dense blocks, shape
            (m, 3k, 3k), of the coordinates x, y, z of node after node of each element, or a scipy.sparse matrix
            (3n, 3n), symmetric and whole [N/mm]. A sparse matrix couples those nodes that it couples at the reference
            positions (stored zeros count), or that `elements` names.
    """

    name: str
    role: str = "internal"
    elements: npt.ArrayLike | None = None
    hessian: Any = None  # not Callable | None, which no method of a derived class may stand for

    def __init_subclass__(cls, **keywords: Any) -> None:
        super().__init_subclass__(**keywords)
        if "name" not in cls.__dict__:
            cls.name = cls.__name__

    def value(self, x: Array) -> float:
        """Energy at x [mJ]; inf where x is not admissible."""
        raise NotImplementedError

    def gradient(self, x: Array) -> Array:
        """Its gradient, shape (n, 3) [N]."""
        raise NotImplementedError


def projected(blocks: Array) -> Array:
    """The nearest positive semidefinite matrix of each symmetric block, (m, s, s)."""
    if not np.isfinite(blocks).all():
        return blocks
    values, vectors = np.linalg.eigh(blocks)
    if values.size == 0 or values.min() >= 0:
        return blocks
    clipped: Array = np.ascontiguousarray((vectors * np.maximum(values, 0)[:, None, :]) @ vectors.swapaxes(1, 2))
    return clipped


def check_term(term: Any, x: npt.ArrayLike, *, step: float = 0.1, seed: int = 0) -> dict[str, Any]:
    """Compares the derivatives of a term of one's own with its values.

    Args:
        term: as in `minimize`.
        x: positions at which the term is smooth and not zero, shape (n, 3) [mm].
        step: largest movement of a node in the random directions [mm].
        seed: of these directions.

    Returns:
        A dict: `passed`; `gradient_slope` and `hessian_slope`, of the Taylor remainders (2 and 3 where the derivatives are
        right, inf where the remainder is nothing but round-off); `gradient_error` and `hessian_error` against central
        differences, relative; `gradient_norm` [N], 0 where nothing was tested; `energy` [mJ]. Without a Hessian its
        two figures are None.

    Raises:
        InputError: x, or what the term returned, has the wrong shape.
    """
    defects: list[str] = []
    positions = _arguments.points(x, "x", defects)
    _arguments.split_terms([term], defects)
    if not (np.isfinite(step) and step > 0):
        defects.append(f"step: is {step}; expected a length above 0 [mm]")
    if positions is not None and (positions.shape[0] == 0 or not np.isfinite(positions).all()):
        defects.append("x: has no nodes, or a coordinate that is not finite")
    if defects or positions is None:
        raise InputError(*defects)
    return _core.check_term(term=term, x=positions, step=step, seed=seed)
