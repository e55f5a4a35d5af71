"""Chord lengths from a closed surface: least squares with the exact Jacobian. Cells (# %%) run in any notebook."""
# %% A small valve, and what an image of it would show: the closed surface of the same valve with other chords.
import warnings

import numpy as np
from scipy.optimize import least_squares
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

import coapt
from coapt import metrics

scene = coapt.generate_mitral("valve", triangles=200, preset="benchmark")
imaged = coapt.Equilibrium(scene, ["chords.lengths"])
first = imaged["chords.lengths"]

# %% One unknown for all the chords of a papillary tip: the parts of the network below the leaflets.
ends = imaged.lines["chords"]
below = ends.min(axis=1) >= imaged.vertex_count
nodes = ends[below]
count = len(imaged.x)
_, part = connected_components(coo_matrix((np.ones(len(nodes)), nodes.T), shape=(count, count)), directed=False)
group = np.unique(part[ends.max(axis=1)], return_inverse=True)[1]
groups = np.equal.outer(group, np.arange(group.max() + 1)) * first[:, None]  # d(lengths)/d(unknowns) [mm]
print(f"{len(first)} chords in {groups.shape[1]} groups")

truth = np.random.default_rng(1).uniform(0.85, 1.0, groups.shape[1])
imaged["chords.lengths"] = groups @ truth
assert imaged.solve().success
V, F = imaged.x[:imaged.vertex_count], imaged.faces

# %% Fit: residuals are the distances of the vertices from that surface.
eq = coapt.Equilibrium(scene, ["chords.lengths"], tol=1e-8)
eq.solve()
residuals = metrics.distance_residuals(eq, V, F)
distance, slope = coapt.objective(eq, residuals)
warnings.simplefilter("ignore", coapt.LostBranchWarning)  # first steps are long: folds of the leaflets may lie otherwise
before = np.linalg.norm(eq.evaluate(residuals))
fit = least_squares(lambda c: distance(groups @ c), np.ones(groups.shape[1]), jac=lambda c: slope(groups @ c) @ groups,
                    bounds=(0.7, 1.2), xtol=1e-6)
after = np.linalg.norm(fit.fun)
print(f"root mean square distance {before:.3f} mm before, {after:.2g} mm after {fit.nfev} shapes, {fit.njev} Jacobians")

# %% Which lengths do the data determine? The singular values of the Jacobian say: 1 % of a factor moves the surface so far.
_, strengths, directions = np.linalg.svd(fit.jac)
error = np.abs(fit.x - truth)
is_determined = np.abs(directions[strengths < 1e-2 * strengths[0]]).max(axis=0, initial=0) < 0.1
worst = (error * np.array([first[group == k].mean() for k in range(len(truth))]))[is_determined].max()
for k in range(len(truth)):
    note = "" if is_determined[k] else "   (the surface hardly depends on it)"
    print(f"group {k}: {fit.x[k]:.4f}, was {truth[k]:.4f}{note}")
