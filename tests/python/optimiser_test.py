"""Equilibria as functions for scipy.optimize, PyTorch and JAX."""
import sys
import warnings

import numpy as np
import pytest
from scipy.optimize import approx_fprime, least_squares, minimize

import coapt
from coapt import autograd, metrics
from valves import MeanSquare, followed, slope


@pytest.fixture(scope="module")
def eq():
    return followed(["chords.length", "papillary.shift"], tol=1e-10)


@pytest.fixture(autouse=True)
def restored(eq):
    start = eq.value
    yield
    eq.value = start
    assert eq.solve().success


def counted(eq, monkeypatch):
    calls = []
    solve = eq.solve
    monkeypatch.setattr(eq, "solve", lambda: calls.append(1) or solve())
    return calls


def test_an_objective_remembers_where_it_is(eq, monkeypatch):
    fun, jac = coapt.objective(eq, metrics.strain_energy(eq))
    calls = counted(eq, monkeypatch)
    start = eq.value
    first = fun(start)
    gradient = jac(start)
    assert len(calls) == 1 and fun(start) == first and len(calls) == 1
    assert gradient == pytest.approx(approx_fprime(start, fun, 1e-5), rel=1e-3, abs=1e-4)
    assert fun(start) == pytest.approx(first, rel=1e-9)
    eq["chords.length"] = 0.99  # behind its back
    before = len(calls)
    assert fun(start) == pytest.approx(first, rel=1e-9) and len(calls) == before + 1


@pytest.mark.filterwarnings("ignore::coapt.LostBranchWarning")  # first steps are long
def test_least_squares_finds_the_parameters_of_a_shape(eq):
    start = eq.value
    truth = start + [-0.04, 0.3, -0.2, 0.4]
    eq.value = truth
    assert eq.solve().success
    V, F = eq.x[:eq.vertex_count], eq.faces
    residuals = metrics.distance_residuals(eq, V, F)
    fun, jac = coapt.objective(eq, residuals)
    fit = least_squares(fun, start, jac=jac, xtol=1e-7)
    assert np.abs(fit.x - truth).max() < 2e-3, fit.x - truth
    assert fit.nfev <= 25


@pytest.mark.filterwarnings("ignore::coapt.LostBranchWarning")
def test_minimize_goes_downhill_within_bounds(eq):
    fun, jac = coapt.objective(eq, MeanSquare((0.0, 0.0, -10.0)))
    start = eq.value
    bounds = [(0.95, 1.05), *[(-0.5, 0.5)] * 3]
    found = minimize(fun, start, jac=jac, bounds=bounds, method="L-BFGS-B", options={"maxiter": 6})
    assert found.fun < fun(start) - 1e-3
    assert all(low <= x <= high for (low, high), x in zip(bounds, found.x))


def test_a_shape_that_does_not_converge_is_no_number(eq, monkeypatch):
    failed = coapt.WarmSolve(False, coapt.Status.ITERATION_LIMIT, "it did not", 1.0, 9, 0.1)
    monkeypatch.setattr(eq, "solve", lambda: failed)
    fun, jac = coapt.objective(eq, [MeanSquare(), MeanSquare()])
    assert fun(eq.value).tolist() == [np.inf, np.inf]
    assert coapt.objective(eq, MeanSquare()).fun(eq.value) == np.inf
    with pytest.raises(coapt.InputError, match="no derivatives at these parameters, for it did not"):
        jac(eq.value)


def test_a_lost_branch_is_warned_of(eq, monkeypatch):
    solve = eq.solve

    def lost():
        solved = solve()
        branch = coapt.LostBranch(1.0, 2.0, 0, 1)
        return coapt.WarmSolve(True, solved.status, "another branch", solved.residual, 1, 0.1, lost_branch=branch)

    monkeypatch.setattr(eq, "solve", lost)
    with pytest.warns(coapt.LostBranchWarning, match="another branch"):
        coapt.objective(eq, MeanSquare()).fun(eq.value)


@pytest.mark.parametrize(("name", "function"), [("torch", autograd.torch_function), ("jax", autograd.jax_function)])
def test_without_the_package_it_says_what_is_missing(eq, monkeypatch, name, function):
    monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(ImportError, match=f"needs the package {name}"):
        function(eq)


def imported(name):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of their own imports
        return pytest.importorskip(name, reason=f"{name} is not installed; coapt.autograd is not tested with it")


def losses(eq):
    """Values of three kinds, as functions of the numbers by NumPy."""
    own = [metrics.strain_energy(eq), MeanSquare()]

    def at(numbers):
        eq.value = numbers
        assert eq.solve().success
        return (eq.x[:60] ** 2).sum() * 1e-3, eq.evaluate(own[0]), eq.evaluate(own) @ [0.5, 2.0]

    return own, at


def checked(eq, gradients, at):
    start = eq.value
    direction = np.array([0.3, -1, 0.5, 0.8])
    differences = slope(lambda h: np.array(at(start + h * direction)), 1e-5)
    for gradient, difference in zip(gradients, differences):
        assert gradient @ direction == pytest.approx(difference, rel=1e-5)


def test_torch_differentiates_shapes_and_metrics(eq):
    torch = imported("torch")
    own, at = losses(eq)
    start = eq.value
    shape, energy, both = (autograd.torch_function(eq, what) for what in (None, own[0], own))
    kinds = [lambda p: 1e-3 * (shape(p)[:60] ** 2).sum(), energy, lambda p: both(p) @ torch.tensor([0.5, 2.0]).to(p)]
    gradients = []
    for kind, value in zip(kinds, at(start)):
        p = torch.tensor(start, requires_grad=True)
        loss = kind(p)
        assert loss.item() == pytest.approx(value, rel=1e-9)
        loss.backward()
        gradients.append(p.grad.numpy())
    checked(eq, gradients, at)
    single = torch.tensor(start, dtype=torch.float32, requires_grad=True)
    energy(single).backward()
    assert single.grad.dtype == torch.float32
    assert single.grad.numpy() == pytest.approx(gradients[1], rel=1e-3, abs=1e-3)
    two = torch.tensor(start, requires_grad=True)  # backward at another place than the last forward
    first = energy(two)
    energy(two.detach() + 1e-5)
    first.backward()
    assert two.grad.numpy() == pytest.approx(gradients[1], rel=1e-6, abs=1e-6)


def test_jax_differentiates_shapes_and_metrics(eq):
    jax = imported("jax")
    jax.config.update("jax_enable_x64", True)
    own, at = losses(eq)
    shape, energy, both = (autograd.jax_function(eq, what) for what in (None, own[0], own))
    kinds = [lambda p: 1e-3 * (shape(p)[:60] ** 2).sum(), energy, lambda p: both(p) @ jax.numpy.array([0.5, 2.0])]
    start = eq.value
    gradients = [np.asarray(jax.jit(jax.grad(kind))(start)) for kind in kinds]
    checked(eq, gradients, at)
