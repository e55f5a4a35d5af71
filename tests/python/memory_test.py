"""Solves, cold and warm, with terms, callbacks, metrics and derivatives: each leaves less behind than a tenth of its x.

What is in use is counted, not what the process holds: the heap's own count for the library and for NumPy, tracemalloc's
for Python's objects, so that one array kept by each solve cannot hide in pages that were there before.
"""
import ctypes
import gc
import os
import tracemalloc

import numpy as np
import pytest

import coapt
from coapt import metrics
from meshes import ELASTIC, PRESSURE, disc
from valves import MeanSquare, followed, scene_file

SOLVES = int(os.environ.get("COAPT_MEMORY_SOLVES", "50"))
TRIANGLES = 600  # of the valve: x is 9 kB
SHARE = 0.1  # of x: what caches that still grow may leave behind
ROWS = 3
GROWTH = 2 << 20  # of the process [bytes]: a thirtieth of what it holds, 1 kB for each of 2,000 solves
WARM_UP = 80  # until caches, free lists and work arrays have their size: 70 were seen to be needed


class HeapCounts(ctypes.Structure):
    """struct mallinfo2 of the C library."""
    _fields_ = [(name, ctypes.c_size_t) for name in ("arena", "ordblks", "smblks", "hblks", "hblkhd", "usmblks",
                                                     "fsmblks", "uordblks", "fordblks", "keepcost")]


def bytes_in_use() -> tuple[int, int]:
    """Of the heap, small and large blocks; of Python's objects and NumPy's arrays."""
    gc.collect()
    library = ctypes.CDLL(None)
    library.mallinfo2.restype = HeapCounts
    counts = library.mallinfo2()
    return counts.uordblks + counts.hblkhd, tracemalloc.get_traced_memory()[0]


def left_behind(solve, count: int) -> float:
    """Bytes that a call of solve(k) leaves behind: the least of three rows of calls, `count` in all. What each call
    leaves stands in every row; a cache that grows once does not."""
    each = -(-count // ROWS)
    tracemalloc.start()
    try:
        for k in range(WARM_UP):
            solve(k)
        grown = []
        for _ in range(ROWS):
            before = bytes_in_use()
            for k in range(each):
                solve(k)
            grown.append(max(last - first for last, first in zip(bytes_in_use(), before)) / each)
        return min(grown)
    finally:
        tracemalloc.stop()


class Pull(coapt.Term):
    role = "load"

    def value(self, x):
        return -1e-4 * x[0, 2]

    def gradient(self, x):
        gradient = 0 * x
        gradient[0, 2] = -1e-4
        return gradient


def test_an_array_that_every_call_keeps_is_seen():
    kept = []
    size = np.zeros((200, 3)).nbytes
    assert left_behind(lambda k: kept.append(np.full((200, 3), float(k))), 50) == pytest.approx(size, rel=0.1)
    assert left_behind(lambda k: np.full((200, 3), float(k)), 50) < SHARE * size


def test_solves_of_a_mesh_leave_nothing_behind():
    V, F = disc(8)

    def solve(k):
        terms = [ELASTIC, PRESSURE, Pull()] if k % 2 else [ELASTIC, PRESSURE]
        result = coapt.minimize(V, F, terms, fixed="boundary", method="lbfgs" if k % 2 else "newton",
                                callback=lambda at: at.x is not None)
        assert result.success and result.fields and result.history.size and result.lines.size == 0

    assert left_behind(solve, SOLVES) < SHARE * V.nbytes


def test_solves_of_a_valve_leave_nothing_behind():
    """Chords and contact: a few steps from a shape that is nearly closed."""
    nearly = coapt.solve(scene_file(TRIANGLES), tol=1e-4).x

    def solve(k):
        result = coapt.solve(scene_file(TRIANGLES), x0=nearly, tol=1e-9, callback=lambda at: at.x is not None)
        assert result.success and result.nit > 0 and result.lines.size and "gap" in result.fields

    assert left_behind(solve, SOLVES) < SHARE * nearly.nbytes


def test_the_process_stays_as_large_as_it_is(capsys):
    """What the process holds, pages that the heap keeps included, from a tenth of the solves on."""
    V, F = disc(8)

    def resident():
        with open("/proc/self/statm") as sizes:
            return int(sizes.read().split()[1]) * os.sysconf("SC_PAGESIZE")

    held = []
    for k in range(SOLVES):
        assert coapt.minimize(V, F, [ELASTIC, PRESSURE], fixed="boundary").success
        if k + 1 >= SOLVES // 10:
            held.append(resident())
    with capsys.disabled():
        print(f"\n{SOLVES} solves: {held[0] / 2**20:.1f} MB after the first tenth, {held[-1] / 2**20:.1f} MB at the end")
    assert held[-1] - held[0] < GROWTH


def test_warm_solves_with_gradients_leave_nothing_behind():
    eq = followed(["chords.length", "load_pressure.pressure", "annulus.positions"], tol=1e-9, triangles=TRIANGLES)
    start, kept = eq.value, []

    def solve(k):
        eq.value = start * (1 + 1e-3 * (k % 3))
        assert eq.solve().success
        own = [metrics.strain_energy(eq), MeanSquare()]
        values, jacobian = eq.evaluate(own), eq.jacobian(own)
        assert jacobian.shape == (2, start.size) and (values > 0).all() and eq.switches(1e-13 * start) == []
        kept[:] = eq.x, eq.response(start), eq.value_and_grad(own[1]), eq.pull_back(own[1].gradient(eq.x))

    assert left_behind(solve, SOLVES) < SHARE * eq.x.nbytes
    assert np.isfinite(kept[1]).all()
