"""Figures of merit as functions of the parameters, for optimisers."""
from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, cast

import numpy as np
import numpy.typing as npt

from ._equilibrium import Equilibrium
from ._errors import InputError
from ._warm_solve import WarmSolve
from .metrics import MetricLike

Array = npt.NDArray[np.float64]


class LostBranchWarning(RuntimeWarning):
    """The shape has changed to another branch of equilibria: the function jumps there."""


class Objective(NamedTuple):
    """A function of the parameters and its derivative, as scipy.optimize takes them."""
    fun: Callable[[npt.ArrayLike], Any]  #: numbers -> value, or values (m,) of several metrics
    jac: Callable[[npt.ArrayLike], Array]  #: numbers -> gradient (numbers,), or Jacobian (m, numbers)


class Follower:
    """Solves for an equilibrium where it is asked for, and remembers where it is."""

    def __init__(self, equilibrium: Equilibrium) -> None:
        self.equilibrium = equilibrium
        self.at: Array | None = None
        self.warm_solve: WarmSolve | None = None

    def go(self, numbers: npt.ArrayLike) -> WarmSolve:
        """The equilibrium at these numbers; a solve only where it is elsewhere."""
        wanted = np.array(numbers, dtype=np.float64)
        here = self.equilibrium.value
        is_here = self.at is not None and np.array_equal(self.at, wanted) and np.array_equal(here, wanted)
        if not is_here or self.warm_solve is None:
            self.at = self.warm_solve = None
            self.equilibrium.value = wanted
            self.warm_solve = self.equilibrium.solve()
            self.at = wanted
            if self.warm_solve.lost_branch is not None:
                warnings.warn(self.warm_solve.message, LostBranchWarning, stacklevel=4)
        return self.warm_solve

    def require_solved(self, numbers: npt.ArrayLike) -> None:
        """Raises InputError where it does not converge."""
        warm = self.go(numbers)
        if not warm.success:
            raise InputError(f"equilibrium: no derivatives at these parameters, for {warm.message}")


def objective(equilibrium: Equilibrium, metric: MetricLike | Sequence[MetricLike]) -> Objective:
    """A metric, or a list of residuals, as a function of the vector of all numbers.

        f, jac = coapt.objective(eq, metric)
        scipy.optimize.minimize(f, eq.value, jac=jac, bounds=...)
        f, jac = coapt.objective(eq, residuals)
        scipy.optimize.least_squares(f, eq.value, jac=jac, bounds=...)

    Every call changes the equilibrium to where it is asked for, by a warm solve from where it is; asked again for the same
    numbers it solves nothing. Where the shape does not converge the function is inf (all residuals are), so that a
    method with a step to shorten goes back; there is no derivative there. A branch that is lost on the way is warned of
    (`LostBranchWarning`). Parameters that mean nothing, such as a length below 0, raise InputError: give bounds.
    """
    if isinstance(metric, (list, tuple)) and not metric:
        raise InputError("metric: is an empty list; expected a metric or some residuals")
    follower = Follower(equilibrium)

    def fun(numbers: npt.ArrayLike) -> Any:
        if follower.go(numbers).success:
            return equilibrium.evaluate(metric)
        return np.full(len(metric), np.inf) if isinstance(metric, (list, tuple)) else np.inf

    def jac(numbers: npt.ArrayLike) -> Array:
        follower.require_solved(numbers)
        if isinstance(metric, (list, tuple)):
            return equilibrium.jacobian(metric)
        return equilibrium.value_and_grad(cast(MetricLike, metric))[1]

    return Objective(fun, jac)
