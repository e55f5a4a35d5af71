"""A thousand solves, one after the other, in the memory of the first hundred."""
import coapt
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
