"""A small generated valve, and its equilibria."""
import functools
import pathlib
import tempfile

import numpy as np

import coapt

TRIANGLES = 150
PARAMETERS = ["chords.length", "leaflets.stiffness", "load_pressure.pressure", "annulus.ring", "papillary.shift"]
_FOLDER = tempfile.TemporaryDirectory()


@functools.lru_cache
def scene_file(triangles=TRIANGLES) -> pathlib.Path:
    return coapt.generate_mitral(pathlib.Path(_FOLDER.name) / f"valve{triangles}", triangles=triangles, preset="benchmark")


def followed(parameters=PARAMETERS, tol=2e-11, triangles=TRIANGLES) -> coapt.Equilibrium:
    eq = coapt.Equilibrium(scene_file(triangles), parameters, tol=tol)
    assert eq.solve().success
    return eq


def slope(f, h):
    """Derivative of f at 0, by central differences of fourth order."""
    return (8 * (f(h) - f(-h)) - (f(2 * h) - f(-2 * h))) / (12 * h)


class MeanSquare:
    """A metric in Python: mean square distance of some vertices from a place; junctions of slack chords, which nothing
    holds, are left out."""

    def __init__(self, place=(1.0, 2.0, 3.0), count=60):
        self.place, self.count = np.array(place), count

    def value(self, x):
        return ((x[:self.count] - self.place) ** 2).sum(axis=1).mean()

    def gradient(self, x):
        gradient = np.zeros_like(x)
        gradient[:self.count] = 2 * (x[:self.count] - self.place) / self.count
        return gradient
