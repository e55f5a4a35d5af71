"""Meshes made in NumPy, and what is common to the tests of the module."""
import pathlib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
ELASTIC = {"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"}
PRESSURE = {"type": "load_pressure", "value": "0.1 kPa"}


def square(cells: int, side: float = 10.0) -> tuple[np.ndarray, np.ndarray]:
    """A flat sheet in the plane z = 0, two triangles in each cell, normals up: (n, 3) float64 and (m, 3) int32."""
    ticks = np.linspace(0, side, cells + 1)
    x, y = np.meshgrid(ticks, ticks, indexing="ij")
    vertices = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    node = np.arange(x.size, dtype=np.int32).reshape(x.shape)
    a, b, c, d = (part.ravel() for part in (node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]))
    return vertices, np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def disc(rings: int, radius: float = 10.0) -> tuple[np.ndarray, np.ndarray]:
    """A flat disc in z = 0 of rings with 6, 12, 18, ... vertices, normals up."""
    vertices, triangles, first = [[0.0, 0.0, 0.0]], [], 0
    for ring in range(1, rings + 1):
        inner, first, count = first, len(vertices), 6 * ring
        angles = 2 * np.pi * np.arange(count) / count
        vertices += [[radius * ring / rings * np.cos(t), radius * ring / rings * np.sin(t), 0.0] for t in angles]
        inner_count = max(1, count - 6)
        for k in range(count):
            side, step = divmod(k, ring)
            here = inner + (side * (ring - 1) + step) % inner_count
            triangles.append([first + k, first + (k + 1) % count, here])
            if step + 1 < ring:
                triangles.append([here, first + (k + 1) % count, inner + (side * (ring - 1) + step + 1) % inner_count])
    return np.array(vertices), np.array(triangles, dtype=np.int32)


def edges(triangles: np.ndarray) -> np.ndarray:
    """Each edge once, (k, 2)."""
    both = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    return np.unique(both, axis=0)
