"""A thousand solves, and a thousand warm ones with gradients, in the memory of the first hundred."""
import coapt
from coapt import metrics
from meshes import ELASTIC, PRESSURE, disc


def resident_mb() -> float:
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * 4096 / 2**20


class Pull(coapt.Term):
    role = "load"

    def value(self, x):
        return -1e-4 * x[0, 2]

    def gradient(self, x):
        gradient = 0 * x
        gradient[0, 2] = -1e-4
        return gradient


def test_a_thousand_solves_leave_nothing_behind():
    V, F = disc(2)
    seen = []
    for k in range(1000):
        terms = [ELASTIC, PRESSURE, Pull()] if k % 2 else [ELASTIC, PRESSURE]
        result = coapt.minimize(V, F, terms, fixed="boundary", method="lbfgs" if k % 2 else "newton",
                                callback=lambda at: at.x is not None)
        assert result.success
        if k % 100 == 99:
            seen.append(resident_mb())
    assert seen[-1] - seen[0] < 1, seen


class Height:
    def value(self, x):
        return x[0, 2]

    def gradient(self, x):
        gradient = 0 * x
        gradient[0, 2] = 1
        return gradient


def test_a_thousand_warm_solves_with_gradients_leave_nothing_behind(tmp_path):
    V, F = disc(3)
    with open(tmp_path / "disc.obj", "w") as file:
        file.writelines(f"v {x} {y} {z}\n" for x, y, z in V)
        file.writelines(f"f {a} {b} {c}\n" for a, b, c in F + 1)
    eq = coapt.Equilibrium({"mesh": {"file": tmp_path / "disc.obj"}, "boundary": [{"nodes": "boundary", "fix": True}],
                            "terms": [{**ELASTIC, "name": "sheet"}, {**PRESSURE, "name": "push"}]},
                           ["push.pressure", "sheet.stiffness", "boundary.positions"], tol=1e-9)
    assert eq.settle().success
    start, seen, kept = eq.value, [], None
    for k in range(1000):
        eq.value = start * (1 + 0.01 * (k % 7))
        assert eq.settle().success
        own = [metrics.strain_energy(eq), Height()]
        values, jacobian = eq.evaluate(own), eq.jacobian(own)
        assert jacobian.shape == (2, start.size) and (values > 0).all() and eq.switches(1e-6 * start) == []
        kept = eq.x, eq.response(start), eq.value_and_grad(own[1])
        if k % 100 == 99:
            seen.append(resident_mb())
    assert kept is not None and seen[-1] - seen[0] < 1, seen
