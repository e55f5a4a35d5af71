"""Equilibria that are followed: parameters, warm solves, derivatives against differences, threads, refusals."""
import contextlib
import os
import signal
import threading
import time
import warnings

import numpy as np
import pytest

import coapt
from coapt import metrics
from meshes import ELASTIC, PRESSURE, disc
from valves import PARAMETERS, MeanSquare, followed, scene_file, slope


@pytest.fixture(scope="module")
def eq():
    return followed()


@pytest.fixture(scope="module")
def fresh(eq):
    """The equilibrium, back at its first numbers after the test."""
    return eq, eq.value


@pytest.fixture(autouse=True)
def restored(request):
    yield
    if "fresh" in request.fixturenames:
        eq, start = request.getfixturevalue("fresh")
        eq.value = start
        assert eq.solve().success


def target(eq):
    """The closed mesh, moved: a surface that is near and nowhere touches."""
    return eq.x[:eq.vertex_count] + [0.3, -0.2, 0.7], eq.faces


def all_metrics(eq):
    V, F = target(eq)
    strongest = max(range(len(eq.lines["chords"])), key=lambda k: eq.evaluate(metrics.line_force(eq, "chords", k)))
    return [metrics.surface_distance(eq, V, F), metrics.surface_distance(eq, V, F, sharpness=2.0, name="farthest"),
            metrics.distance_residuals(eq, V, F)[20], metrics.orifice_area(eq, blur=3.0),
            metrics.coaptation_area(eq, range=2.0), metrics.coaptation_height(eq, range=2.0, sharpness=1.0),
            metrics.line_force(eq, "chords", strongest), metrics.line_force_norm(eq, "chords"),
            metrics.strain_energy(eq), metrics.node_position(eq, [5, 20], [0.1, -0.3, 1.0]), MeanSquare()]


def test_parameters_have_their_shapes_and_come_back_to_the_bit(eq):
    assert eq.parameters == PARAMETERS and set(PARAMETERS) < set(eq.available)
    assert {"chords.lengths", "annulus.positions", "annulus.rest"} <= set(eq.available)
    shapes = {name: array.shape for name, array in eq.split(eq.value).items()}
    assert shapes == {"chords.length": (1,), "leaflets.stiffness": (1,), "load_pressure.pressure": (1,),
                      "annulus.ring": (4,), "papillary.shift": (3,)}
    assert eq["annulus.ring"].tolist() == [1, 1, 1, 0] and eq["chords.length"] == 1
    assert abs(eq["load_pressure.pressure"][0]) == pytest.approx(120 * 133.322e-6, rel=1e-5)
    before = eq.value
    eq.value = before
    assert np.array_equal(eq.value, before)
    eq.value_and_grad(MeanSquare())  # still solved: nothing has changed


def test_keys_of_the_scene_are_names_too():
    eq = followed(["chords.length_scale", "load_pressure.value"], tol=1e-9)
    other = followed(["chords.length", "load_pressure.pressure"], tol=1e-9)
    assert eq["chords.length_scale"] == pytest.approx(1)
    assert eq["load_pressure.value"][0] == pytest.approx(120 * 133.322e-6, rel=1e-5)
    assert other["load_pressure.pressure"][0] == pytest.approx(-eq["load_pressure.value"][0], rel=1e-12)
    change = np.array([0.01, 1e-4])
    assert np.abs(eq.response(change) - other.response(change * [1, -1])).max() < 1e-8 < np.abs(eq.response(change)).max()
    for this, name, sign in ((eq, "load_pressure.value", 1), (other, "load_pressure.pressure", -1)):
        this[name] = sign * 1.02 * abs(this[name])
        assert this.solve().success
    assert np.abs(eq.x - other.x).max() < 1e-6
    with pytest.raises(coapt.InputError, match="keep its sign"):
        eq["load_pressure.value"] = -0.01
        eq.solve()


def test_places_are_those_of_the_input():
    eq = coapt.Equilibrium(scene_file(), ["annulus.positions", "free_edge.rest", "chords.lengths"])
    annulus = eq.sets["annulus"]
    assert eq["annulus.positions"].shape == (len(annulus), 3)
    assert np.allclose(eq["annulus.positions"], eq.x[annulus], atol=1e-12)
    assert eq["free_edge.rest"].shape == (len(eq.sets["free_edge"]), 3)
    assert eq["chords.lengths"].shape == (len(eq.lines["chords"]),) and (eq["chords.lengths"] > 1).all()
    moved = eq["annulus.positions"] + [0, 0, 0.05]
    eq["annulus.positions"] = moved
    assert eq.solve().success
    assert np.allclose(eq.x[annulus], moved, atol=1e-12) and np.array_equal(eq["annulus.positions"], moved)


def test_positions_are_read_only_views_that_stay_what_they_were(fresh):
    eq, _ = fresh
    before, kept = eq.x, eq.x.copy()
    assert before.base is not None and before.shape == (before.shape[0], 3)
    with pytest.raises(ValueError, match="read-only"):
        before[0] = 1
    with pytest.raises(ValueError, match="read-only"):
        eq.faces[0] = 1
    eq["chords.length"] = 0.98
    assert eq.solve().success
    assert np.array_equal(before, kept) and np.abs(eq.x - kept).max() > 1e-3


def test_a_warm_solve_is_a_few_steps():
    eq = followed(["chords.lengths"], tol=1e-8, triangles=300)
    assert eq.first.success and eq.first.iterations > 10
    start, travel, steps = eq.value, [], []
    for chord in range(0, start.size, 10):
        changed = start.copy()
        changed[chord] -= 0.1
        for value in (changed, start):
            eq.value = value
            warm = eq.solve()
            assert warm.success and warm.status == coapt.Status.CONVERGED and warm.residual <= 1e-8
            assert warm.is_quick and warm.lost_branch is None
            steps.append(warm.iterations)
            assert "converged" in warm.message
            travel.append((warm.travel, warm.predicted))
    assert np.min(np.max(travel, axis=0)) > 0.01
    assert np.median(steps) <= 5 and max(steps) < 15, steps  # more where a kink is on the way


def test_a_warm_solve_counts_its_switches_where_it_is_shown(fresh):
    eq, start = fresh
    eq.value = start * 1.02
    warm = eq.solve()
    assert warm.switched and all(isinstance(each, coapt.Switch) for each in warm.switched)
    assert f"switched=<{len(warm.switched)} of Switch>" in repr(warm)
    assert "message=" in repr(warm) and "Switch(" not in repr(warm) and len(repr(warm)) < 800


def test_derivatives_are_those_of_differences(fresh):
    eq, start = fresh
    step = 1e-5
    direction = np.where(np.arange(start.size) % 2, -1.0, 0.7) * np.where(start == 0, 0.1, np.abs(start))
    assert eq.switches(3 * step * direction) == []  # no kink on the way
    own = all_metrics(eq)
    exact = np.array([eq.value_and_grad(metric)[1] @ direction for metric in own])
    assert np.allclose(eq.jacobian(own) @ direction, exact, rtol=1e-9)

    def at(h):
        eq.value = start + h * direction
        assert eq.solve().success
        return eq.evaluate(own)

    differences = slope(at, step)
    names = [getattr(metric, "name", "own") for metric in own]
    for name, one, other in zip(names, exact, differences):
        assert one == pytest.approx(other, rel=1e-6), name
    assert np.abs(exact).min() > 1e-6


def test_transposes_products_and_covariances_agree(eq):
    V, F = target(eq)
    residuals = [*metrics.distance_residuals(eq, V, F)[:12], MeanSquare(), metrics.strain_energy(eq)]
    jacobian = eq.jacobian(residuals)
    assert jacobian.shape == (14, eq.value.size)
    random = np.random.default_rng(7)
    change, weights = random.normal(size=eq.value.size) * 0.01, random.normal(size=len(residuals))
    motion = eq.response(change)
    pull = random.normal(size=motion.shape)
    pull[eq.vertex_count:] = 0  # junctions of slack chords hang loose
    assert motion.shape == eq.x.shape
    assert (pull * motion).sum() == pytest.approx(eq.pull_back(pull) @ change, rel=1e-7)
    assert eq.weighted_gradient(residuals, weights) == pytest.approx(weights @ jacobian, rel=1e-7, abs=1e-9)
    assert eq.gauss_newton_product(residuals, change) == pytest.approx(jacobian.T @ (jacobian @ change), rel=1e-6)
    covariance = np.diag(np.linspace(1, 2, change.size) * 1e-4)
    covariance[0, 1] = covariance[1, 0] = 5e-5
    assert eq.metric_covariance(residuals, covariance) == pytest.approx(jacobian @ covariance @ jacobian.T, rel=1e-9)
    values = eq.evaluate(residuals)
    assert values[-1] == eq.value_and_grad(residuals[-1])[0] == eq.evaluate(residuals[-1])


def test_switches_name_what_is_about_to_change(eq):
    change = np.zeros(eq.value.size)
    change[0] = 0.05
    found = eq.switches(change)
    assert {"chords", "contact_barrier"} <= {each.term for each in found}
    assert all(each.before != each.after for each in found if each.term == "chords")
    assert eq.switches(1e-13 * change) == []


def test_kinks_are_told_without_being_asked_for(eq):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        eq.value_and_grad(MeanSquare())  # rounded chords have none
    assert eq.kinks() == []

    scene = scene_file().with_name("sharp.json")
    scene.write_text(scene_file().read_text().replace('"type": "cable",', '"type": "cable", "smoothing": 0,'))
    sharp = coapt.Equilibrium(scene, ["chords.lengths"], tol=1e-9)
    assert sharp.solve().success
    ends, lengths = sharp.lines["chords"], sharp["chords.lengths"]
    apart = np.linalg.norm(sharp.x[ends[:, 0]] - sharp.x[ends[:, 1]], axis=1)
    is_slack = apart < 0.999 * lengths
    # A slack chord at a branch point that taut ones hold: its length moves nothing as long as it is slack.
    slack = next(k for k in np.flatnonzero(is_slack) if not any(
        is_slack[other] for other in range(len(ends)) if other != k and ends[k, 0] in ends[other]))

    def found(switches):
        return [each[2:] for each in switches if each[:2] == ("chords", slack)]

    assert found(sharp.kinks()) == []
    lengths[slack] = apart[slack]
    sharp["chords.lengths"] = lengths
    assert sharp.solve().success
    assert found(sharp.kinks()) == [("slack", "taut", True)]
    with pytest.warns(coapt.KinkWarning, match="chords, element .*: stands between slack and taut"):
        sharp.value_and_grad(metrics.strain_energy(sharp))

    lengths[slack] = 0.97 * apart[slack]
    sharp["chords.lengths"] = lengths
    warm = sharp.solve()
    assert warm.success and found(warm.switched)[0][1:] == ("taut", True)
    assert found(sharp.kinks()) == []


def test_several_threads_give_the_same_bits():
    results = [None] * 3

    def work(k):
        eq = followed()
        eq["chords.length"] = 0.99
        assert eq.solve().success
        results[k] = eq.x.copy(), *eq.value_and_grad(MeanSquare())

    work(2)
    threads = [threading.Thread(target=work, args=(k,)) for k in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for k in range(2):
        assert all(np.array_equal(one, other) for one, other in zip(results[k], results[2]))


def test_one_object_serves_one_call_at_a_time(eq):
    class Nosy(MeanSquare):
        def value(self, x):
            eq.solve()
            return 0.0

    with pytest.raises(coapt.InputError, match="another call is at work"):
        eq.value_and_grad(Nosy())
    eq.value_and_grad(MeanSquare())


def test_what_a_metric_raises_reaches_the_caller(eq):
    error = LookupError("mine")

    class Bad(MeanSquare):
        def gradient(self, x):
            raise error

    with pytest.raises(LookupError) as caught:
        eq.value_and_grad(Bad())
    assert caught.value is error
    assert eq.evaluate(Bad()) > 0


def test_ctrl_c_ends_a_solve_that_may_go_on(tmp_path):
    scene = coapt.generate_mitral(tmp_path / "valve", triangles=2500, preset="benchmark")
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    start = time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        coapt.Equilibrium(scene, ["chords.length"])
    timer.join()
    assert time.monotonic() - start < 60


def test_ctrl_c_during_solve_leaves_a_shape_to_go_on_from(fresh):
    eq, start = fresh
    places = []

    def interrupt(number, frame):
        places.append(frame.f_code.co_name)
        raise KeyboardInterrupt

    def is_solved():
        try:
            eq.value_and_grad(MeanSquare())
        except coapt.InputError:
            return False
        return True

    former = signal.signal(signal.SIGALRM, interrupt)  # a signal that a timer sends, so that it comes in the middle
    try:
        for k in range(100):
            places.clear()
            eq.value = start
            eq["chords.length"] = 0.97 if k % 2 else 1.0
            with contextlib.suppress(KeyboardInterrupt):
                signal.setitimer(signal.ITIMER_REAL, 2e-3)
                eq.solve()
                signal.setitimer(signal.ITIMER_REAL, 0)
            if "solve" in places and not is_solved():  # a signal at its very end finds the work done
                break
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, former)
    assert "solve" in places and np.isfinite(eq.x).all()
    with pytest.raises(coapt.InputError, match=r"solve\(\)"):
        eq.value_and_grad(MeanSquare())
    assert eq.solve().success


def test_ctrl_c_ends_a_jacobian_between_two_of_its_linear_systems():
    eq = followed(["chords.lengths"], tol=1e-8, triangles=300)
    asked = []

    class Counted(MeanSquare):
        def gradient(self, x):
            asked.append(1)
            return super().gradient(x)

    figures = [Counted(), *[coapt.metrics.strain_energy(eq)] * (eq.value.size - 2), Counted()]
    start = time.monotonic()
    assert eq.jacobian(figures).shape == (eq.value.size, eq.value.size) and len(asked) == 2
    whole = time.monotonic() - start

    def interrupt(number, frame):
        raise KeyboardInterrupt

    former = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1 * whole)
        with pytest.raises(KeyboardInterrupt):
            eq.jacobian(figures)
        assert len(asked) == 3, "the last figure was never reached"
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, former)
    assert np.isfinite(eq.jacobian(figures[:1])).all()


def test_a_snap_is_a_lost_branch(tmp_path):
    """A flat pyramid clamped at its foot: pressed from above it snaps through, and does not come back."""
    V, F = disc(1)
    V[0, 2] = 1.5
    with open(tmp_path / "pyramid.obj", "w") as file:
        file.writelines(f"v {x} {y} {z}\n" for x, y, z in V)
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in F + 1)
    eq = coapt.Equilibrium({"mesh": {"file": tmp_path / "pyramid.obj"}, "boundary": [{"nodes": "boundary", "fix": True}],
                            "terms": [ELASTIC, {**PRESSURE, "name": "push", "side": "front", "value": "1 Pa"}]},
                           ["push.pressure"], tol=1e-9)
    assert eq.solve().success and eq.x[0, 2] > 1.4
    lost = []
    for _ in range(40):
        eq["push.pressure"] = 1.3 * eq["push.pressure"]
        warm = eq.solve()
        assert warm.success
        lost.append(warm.lost_branch)
        if eq.x[0, 2] < 0:
            break
    assert eq.x[0, 2] < 0 and not any(lost[:-1])
    assert lost[-1].distance > 1 and "another branch" in warm.message
    # Its anchor, the first shape, is on the branch that it left.
    here = np.array(eq.x)
    check = eq.check_anchor()
    assert check.status == coapt.Status.CONVERGED and not check.is_same_branch
    assert check.back > 1 and "has left the branch" in check.message
    assert np.array_equal(eq.x, here)
    eq.anchor_here()
    assert eq.check_anchor().is_same_branch


@pytest.mark.parametrize(("call", "pieces"), [
    (lambda eq: eq["chord.length"], ["'chord.length': is no parameter", "chords.length"]),
    (lambda eq: eq.__setitem__("annulus.ring", [1, 1, 1]), ["annulus.ring: has shape (3,)", "shape (4,)"]),
    (lambda eq: eq.__setitem__("chords.length", "long"), ["chords.length: has dtype <U4"]),
    (lambda eq: eq.__setitem__("chords.length", -1.0), ["chords.length", "must stay positive"]),
    (lambda eq: eq.__setitem__("chords.length", np.nan), ["chords.length: holds a number that is not finite"]),
    (lambda eq: setattr(eq, "value", np.ones(3)), ["value: has shape (3,)", "(10,)"]),
    (lambda eq: eq.response(np.ones((10, 1))), ["change: has shape (10, 1)"]),
    (lambda eq: eq.pull_back(np.ones((2, 3))), ["weights: has shape (2, 3)"]),
    (lambda eq: eq.metric_covariance([MeanSquare()], np.eye(2)), ["covariance: has shape (2, 2)", "(10, 10)"]),
    (lambda eq: eq.metric_covariance([MeanSquare()], -np.eye(10)), ["negative eigenvalue"]),
    (lambda eq: eq.value_and_grad(7), ["metric: is a int", "value(x) and gradient(x)"]),
    (lambda eq: eq.value_and_grad(type("Flat", (MeanSquare,), {"gradient": lambda self, x: x[0]})()),
     ['metric "Flat": gradient(): has shape (3,)']),
    (lambda eq: eq.evaluate(type("Text", (MeanSquare,), {"value": lambda self, x: np.nan})()), ["finite number"]),
    (lambda eq: metrics.line_force(eq, "chord", 0), ['no term "chord"', "chords"]),
    (lambda eq: metrics.line_force(eq, "chords", 9999), ["no line 9999"]),
    (lambda eq: metrics.surface_distance(eq, eq.x[:3], [[0, 1, 7]]), ["F: triangle 0 has corners"]),
    (lambda eq: metrics.surface_distance(eq, eq.x[:3]), ["needs both"]),
    (lambda eq: metrics.surface_distance(eq), ["has no target"]),
    (lambda eq: metrics.orifice_area(eq, annulus="ring"), ["there is no set 'ring'", "annulus"]),
    (lambda eq: metrics.node_position(eq, [10**6], [0, 0, 1]), ["nodes: holds a node that does not exist"]),
    (lambda eq: coapt.objective(eq, []), ["metric: is an empty list"]),
    (lambda eq: eq.add("chords.lengths"), ['"chords.lengths": changes the rest length of line 0 of term "chords"', '"chords.length"']),
    (lambda eq: eq.add("papillary.positions"), ["changes the place of node", 'which "papillary.shift" changes']),
    (lambda eq: eq.add("chords.length"), ["of that name"]),
])
def test_bad_input_names_the_argument_and_what_was_expected(eq, call, pieces):
    before = eq.value
    with pytest.raises(coapt.InputError) as caught:
        call(eq)
    for piece in pieces:
        assert piece in str(caught.value), str(caught.value)
    assert np.array_equal(eq.value, before)


def test_every_defect_of_a_new_one_is_said_in_one_pass(tmp_path):
    with pytest.raises(coapt.InputError) as caught:
        coapt.Equilibrium(7, ["a", 3], tol=-1, max_seconds=0)
    assert {defect.split(":")[0] for defect in caught.value.defects} == {"scene", "parameters[1]", "tol", "max_seconds"}
    with pytest.raises(coapt.InputError) as caught:
        coapt.Equilibrium(scene_file(), ["chords.lenght", "leaflet.stiffness"])
    assert len(caught.value.defects) == 2 and 'did you mean "chords.length"' in str(caught.value)
    with pytest.raises(coapt.InputError, match="triangles: is 7"):
        coapt.generate_mitral(tmp_path, triangles=7)


def test_derivatives_want_a_solved_shape(fresh):
    eq, _ = fresh
    other = coapt.Equilibrium(scene_file(), ["chords.length"])
    with pytest.raises(coapt.InputError, match=r"solve\(\)"):
        other.value_and_grad(MeanSquare())
    with pytest.raises(coapt.InputError, match="made for another equilibrium"):
        eq.value_and_grad(metrics.strain_energy(other))
    eq["chords.length"] = 0.99
    with pytest.raises(coapt.InputError, match=r"solve\(\)"):
        eq.value_and_grad(MeanSquare())


def test_former_names_still_work_and_say_so(fresh):
    eq, _ = fresh
    with pytest.warns(DeprecationWarning, match=r"Equilibrium\.solve"):
        assert eq.settle().success
    with pytest.warns(DeprecationWarning, match="WarmSolve"):
        assert coapt.Settling is coapt.WarmSolve
    with pytest.raises(AttributeError, match="no_such_name"):
        coapt.no_such_name
