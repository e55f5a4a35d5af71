"""An equilibrium as a differentiable function for PyTorch and JAX, where they are installed.

    shape = coapt.autograd.torch_function(eq)                 # numbers -> positions (n, 3) [mm]
    area = coapt.autograd.torch_function(eq, orifice)         # numbers -> value of a metric
    loss = ((shape(p) - wanted) ** 2).mean() + area(p)
    loss.backward()                                           # p.grad: exact

Forward solves the equilibrium at the given numbers, a vector as `Equilibrium.value`; backward is one linear system. Only
first derivatives: a second differentiation is refused. Nothing here imports either package before it is asked for.
"""
from __future__ import annotations

import importlib
import threading
from collections.abc import Callable, Sequence
from typing import Any, cast

import numpy as np
import numpy.typing as npt

from ._equilibrium import Equilibrium
from ._errors import InputError
from ._objective import Follower
from .metrics import MetricLike

Array = npt.NDArray[np.float64]
__all__ = ["jax_function", "torch_function"]


class _Differentiable:
    """Positions, a metric or several, as a function of the numbers with its transposed derivative."""

    def __init__(self, equilibrium: Equilibrium, metric: MetricLike | Sequence[MetricLike] | None) -> None:
        if isinstance(metric, (list, tuple)) and not metric:
            raise InputError("metric: is an empty list; expected a metric or several")
        self.equilibrium, self.metric = equilibrium, metric
        self.follower = Follower(equilibrium)
        self.lock = threading.Lock()  # frameworks call back from threads of their own

    @property
    def shape(self) -> tuple[int, ...]:
        if self.metric is None:
            return self.equilibrium.x.shape
        return (len(self.metric),) if isinstance(self.metric, (list, tuple)) else ()

    def value(self, numbers: npt.ArrayLike) -> Array:
        with self.lock:
            self.follower.require_solved(numbers)
            if self.metric is None:
                return self.equilibrium.x
            return np.asarray(self.equilibrium.evaluate(self.metric))

    def pull_back(self, numbers: npt.ArrayLike, weights: npt.ArrayLike) -> Array:
        with self.lock:
            self.follower.require_solved(numbers)
            array = np.array(weights, dtype=np.float64)
            if self.metric is None:
                return self.equilibrium.pull_back(array)
            if isinstance(self.metric, (list, tuple)):
                return self.equilibrium.weighted_gradient(self.metric, array)
            gradient: Array = float(array) * self.equilibrium.value_and_grad(cast(MetricLike, self.metric))[1]
            return gradient


def _imported(name: str, remedy: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(f"coapt.autograd needs the package {name} here ({remedy})") from error


def torch_function(equilibrium: Equilibrium,
                   metric: MetricLike | Sequence[MetricLike] | None = None) -> Callable[[Any], Any]:
    """A function of a PyTorch tensor of all numbers, (numbers,), that autograd differentiates.

    Args:
        equilibrium: it moves to where the function is asked for.
        metric: of `coapt.metrics` or one's own; several give a vector (m,), None the positions (n, 3) [mm].

    Returns:
        A function of a floating-point tensor on any device; its result has that tensor's dtype and device.

    Raises:
        ImportError: PyTorch is not installed.
        InputError: of the function, where the shape does not converge or its tangent is singular.
    """
    torch = _imported("torch", "Debian: python3-torch")
    closed = _Differentiable(equilibrium, metric)

    def forward(context: Any, numbers: Any) -> Any:
        context.save_for_backward(numbers)
        value = closed.value(numbers.detach().cpu().numpy())
        return torch.from_numpy(np.array(value)).to(dtype=numbers.dtype, device=numbers.device)

    def backward(context: Any, weights: Any) -> Any:
        (numbers,) = context.saved_tensors
        gradient = closed.pull_back(numbers.detach().cpu().numpy(), weights.detach().cpu().numpy())
        return torch.from_numpy(gradient).to(dtype=numbers.dtype, device=numbers.device)

    once = torch.autograd.function.once_differentiable(backward)
    made: Any = type("Closed", (torch.autograd.Function,),
                     {"forward": staticmethod(forward), "backward": staticmethod(once)})
    function: Callable[[Any], Any] = made.apply
    return function


def jax_function(equilibrium: Equilibrium,
                 metric: MetricLike | Sequence[MetricLike] | None = None) -> Callable[[Any], Any]:
    """A function of a JAX array of all numbers, (numbers,), with reverse-mode derivatives (jax.grad, jax.vjp), also under
    jax.jit. The solve runs on the host. Results have the dtype of the argument: float32 unless JAX's `jax_enable_x64`
    is set, which is advised. JAX raises an error of the solve as one of its own. Arguments as in `torch_function`.

    Raises:
        ImportError: JAX is not installed.
    """
    jax = _imported("jax", "it is no Debian package; see its own installation notes")
    closed = _Differentiable(equilibrium, metric)

    def value_of(numbers: Any) -> Any:
        result = jax.ShapeDtypeStruct(closed.shape, numbers.dtype)
        return jax.pure_callback(lambda p: closed.value(np.asarray(p)).astype(result.dtype), result, numbers)

    def forward(numbers: Any) -> tuple[Any, Any]:
        return value_of(numbers), numbers

    def backward(numbers: Any, weights: Any) -> tuple[Any]:
        result = jax.ShapeDtypeStruct(numbers.shape, numbers.dtype)
        return (jax.pure_callback(
            lambda p, w: closed.pull_back(np.asarray(p), np.asarray(w)).astype(result.dtype), result, numbers, weights),)

    function: Any = jax.custom_vjp(value_of)
    function.defvjp(forward, backward)
    differentiable: Callable[[Any], Any] = function
    return differentiable
