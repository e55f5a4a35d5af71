"""
A tent: form finding
====================

A prestressed cloth between edge cables, held at four corners of which two are higher. The mesh is made in NumPy.
"""
# %%
# A grid of 12 by 12 cells, 10 m wide; lengths are mm.
import numpy as np

import coapt

cells, side, height = 12, 10_000.0, 5_000.0
ticks = np.linspace(0, side, cells + 1)
x, y = np.meshgrid(ticks, ticks, indexing="ij")
V = np.column_stack([x.ravel(), y.ravel(), height * ((x - y) / side).ravel() ** 2])
node = np.arange(x.size).reshape(x.shape)
a, b, c, d = (part.ravel() for part in (node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]))
F = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
corners = node[[0, 0, -1, -1], [0, -1, 0, -1]]

# %%
# The cloth has a prescribed prestress and the cables a tension, no stiffness: the shape follows from their ratio alone.
cloth = {"type": "cst_prestress", "warp": "1 kN/m", "weft": "1 kN/m", "direction": [1, 0, 0]}
cables = {"type": "cable", "name": "edge cables", "edges": "boundary", "tension": "10 kN"}
tent = coapt.minimize(V, F, [cloth, cables], fixed=corners.tolist(), tol=1e-8)
tent

# %%
# Stronger cables straighten the edges; each tent starts from the shape of the one before.
sags = {}
for kilonewtons in (5, 10, 20, 40):
    cables = {**cables, "tension": f"{kilonewtons} kN"}
    tent = coapt.minimize(V, F, [cloth, cables], fixed=corners.tolist(), x0=tent.x, tol=1e-8)
    edge = tent.x[node[0]]
    sags[kilonewtons] = np.abs(edge[:, 0]).max() / side
    print(f"{kilonewtons:3} kN: the edge sags by {100 * sags[kilonewtons]:.1f} % of the width")

# %%
coapt.plot.shape(tent, color=tent.x[:, 2], view=(20, -30))
