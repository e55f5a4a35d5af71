"""Rings of several sizes on one valve, each a warm solve from the one before, with exact slopes."""
# %% A small valve whose annulus is held by a ring: factors on its widths and its height, and a tilt.
import numpy as np
from matplotlib import pyplot

import coapt
from coapt import metrics

scene = coapt.generate_mitral("valve", triangles=200, preset="benchmark")
eq = coapt.Equilibrium(scene, ["annulus.ring"], tol=1e-10)
assert eq.solve().success
ring = eq.x[eq.sets["annulus"]]
width = np.linalg.norm(ring[:, None] - ring, axis=2).max()
figures = {"orifice [mm2]": metrics.orifice_area(eq, blur=1.5), "chord force [N]": metrics.line_force_norm(eq, "chords")}

# %% From the widest to the narrowest: size, values, and how they change for each mm of size.
rows = []
for factor in np.linspace(1.06, 0.86, 6):
    eq["annulus.ring"] = [factor, factor, 1, 0]
    warm = eq.solve()
    assert warm.success, warm.message
    row = [factor * width]
    for metric in figures.values():
        value, gradient = eq.value_and_grad(metric)
        row += [value, gradient[:2].sum() / width]
    rows.append([*row, warm.iterations])
table = np.array(rows)
print("size [mm]  " + "   ".join(f"{name}  per mm" for name in figures) + "   steps")
for row in table:
    print(f"{row[0]:9.1f}  {row[1]:13.2f}  {row[2]:+6.2f}   {row[3]:15.3f}  {row[4]:+6.3f}   {row[5]:5.0f}")

# %% Values over size, with the tangents that the derivatives give.
_, axes = pyplot.subplots(1, 2, figsize=(9, 4))
for k, name in enumerate(figures):
    size, value, slope = table[:, 0], table[:, 1 + 2 * k], table[:, 2 + 2 * k]
    axes[k].plot(size, value, "o-")
    for s, v, d in zip(size, value, slope):
        axes[k].plot([s - 0.6, s + 0.6], [v - 0.6 * d, v + 0.6 * d], "r-", linewidth=1)
    axes[k].set_xlabel("size of the ring [mm]")
    axes[k].set_ylabel(name)
axes[0].figure.savefig("ring_sweep.png")
