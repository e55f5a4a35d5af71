"""coapt.register: a surface brought onto another, from arrays."""
import numpy as np
import pytest

import coapt
from meshes import square

ANGLE = np.pi / 6
TURN = np.array([[np.cos(ANGLE), 0, -np.sin(ANGLE)], [0, 1, 0], [np.sin(ANGLE), 0, np.cos(ANGLE)]])


def sheet():
    """A bent sheet of 40 mm without symmetry."""
    x, triangles = square(20)
    x = 40 * (x - x.mean(axis=0)) / np.ptp(x[:, 0])
    x[:, 2] = 0.02 * x[:, 0] ** 2 - 0.01 * x[:, 1] ** 2 + 0.0008 * x[:, 0] ** 2 * x[:, 1] + 3 * np.sin(x[:, 0] / 5)
    return x, triangles


@pytest.mark.parametrize("options", [{}, {"method": "annulus", "trim": 0.2}, {"scale": True}, {"landmarks": True}])
def test_comes_back_from_30_degrees_and_10_mm(options):
    x, triangles = sheet()
    moved = x @ TURN.T + [6, -8, 0]
    if "landmarks" in options:
        options = {"landmarks": (moved[[0, 20, 200, 400]], x[[0, 20, 200, 400]])}
    found = coapt.register(moved, triangles, x, triangles, **options)
    np.testing.assert_allclose(found.V, x, atol=1e-8)
    np.testing.assert_allclose(found.V, moved @ found.transform[:3, :3].T + found.transform[:3, 3], atol=1e-10)
    assert found.angle_deg == pytest.approx(30) and found.scale == pytest.approx(1)
    assert found.distances_before["to_target"]["mean_mm"] > 0.5
    assert found.distances_after["from_target"]["max_mm"] < 1e-8
    assert found.distance_to_target.shape == (len(x),) and found.warnings == []


def test_what_cannot_be_believed_is_refused():
    x, triangles = sheet()
    with pytest.raises(coapt.InputError, match="mirror image"):
        coapt.register(x, triangles, x * [1, -1, 1], triangles, landmarks=(x[::50], x[::50] * [1, -1, 1]))
    with pytest.raises(coapt.InputError, match="unit of length"):
        coapt.register(0.001 * x, triangles, x, triangles)


@pytest.mark.parametrize("options, words", [({"method": "icp"}, "expected one of"), ({"trim": 1}, "from 0 to 0.9"),
                                            ({"method": "landmarks"}, "need each other"),
                                            ({"landmarks": ([[0, 0, 0]],)}, "expected a pair"), ({"landmarks": 5}, "expected a pair"),
                                            ({"landmarks": (np.full((3, 3), np.nan), np.eye(3))}, "landmarks: holds")])
def test_wrong_arguments_are_named(options, words):
    x, triangles = sheet()
    with pytest.raises(coapt.InputError, match=words):
        coapt.register(x, triangles, x, triangles, **options)
    with pytest.raises(coapt.InputError, match="V: holds a number"):
        coapt.register(np.full_like(x, np.nan), triangles, x, triangles)
