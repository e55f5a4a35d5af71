"""Several solvers on one problem: do they agree, and what does accuracy cost with each of them?"""
# %% An elastic disc, radius 10 mm, clamped at its rim and inflated.
import numpy as np

import coapt
from coapt import plot

rings, triangles, vertices = 10, [], [[0.0, 0.0, 0.0]]
for ring in range(1, rings + 1):
    angles = 2 * np.pi * np.arange(6 * ring) / (6 * ring)
    vertices += np.column_stack([np.cos(angles), np.sin(angles), 0 * angles]).dot(10 * ring / rings).tolist()
V = np.array(vertices)
from scipy.spatial import Delaunay  # noqa: E402

F = Delaunay(V[:, :2]).simplices
a, b, c = V[F].transpose(1, 0, 2)
F[np.cross(b - a, c - a)[:, 2] < 0] = F[np.cross(b - a, c - a)[:, 2] < 0][:, ::-1]
terms = [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"},
         {"type": "load_pressure", "value": "0.1 kPa"}]

# %% Every method of this build that minimises, to three tolerances.
methods = [name for name in coapt.methods() if name in ("newton", "lbfgs", "bfgs", "ceres", "nlopt")]
runs = {name: [coapt.minimize(V, F, terms, fixed="boundary", method=name, tol=tol) for tol in (1e-2, 1e-4, 1e-6)]
        for name in methods}
for name, results in runs.items():
    print(f"{name:8}", *(f"{r.residual:.1e} in {1000 * r.seconds:.0f} ms" for r in results), sep="   ")

# %% They agree.
truth = coapt.minimize(V, F, terms, fixed="boundary", tol=1e-11)
largest_gap = max(np.abs(results[-1].x - truth.x).max() for results in runs.values())
print(f"largest distance of a coordinate from the exact equilibrium: {largest_gap:.1e} mm")

# %% What accuracy costs.
axes = plot.work_precision(runs, truth=truth)
axes.figure.savefig("work_precision.png")
