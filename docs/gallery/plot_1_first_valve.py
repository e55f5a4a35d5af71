"""
A first valve
=============

A mitral valve is generated, closes under systolic pressure, and shows what it looks like and whether it leaks.
"""
# %%
# The generator writes leaflets, chords and a scene into a folder; ``coapt.solve`` finds the closed equilibrium. A notebook
# shows the result by itself: what is to be warned of, the shape, and the figures that this scene defines.
import pathlib
import tempfile

import numpy as np
from matplotlib import pyplot

import coapt

folder = pathlib.Path(tempfile.mkdtemp())
result = coapt.solve(coapt.generate_mitral(folder, triangles=600))
result

# %%
# Figures have names with their units. ``None`` would say that this scene does not define one.
for name in ("orifice_area_mm2", "coaptation_height_mm", "max_principal_strain", "max_chord_force_n"):
    print(f"{name:24} {result.metrics[name]:.3g}")
print(result.certificate["summary"])

# %%
# Where do the leaflets touch? The gap is the distance to the other leaflet, where it is near; grey is far from any. From
# above, as a surgeon sees the valve, and from the side with the chords.
figure, axes = pyplot.subplots(1, 2, figsize=(9, 3.5))
coapt.plot.shape(result, color="gap", view=(90, -90), lines=False, ax=axes[0])
coapt.plot.shape(result, color="gap", view=(10, -90), ax=axes[1])
figure.tight_layout()

# %%
# What do the chords bear?
forces = result.fields["line_force"]
figure, axes = pyplot.subplots(figsize=(6, 3))
axes.bar(np.arange(forces.size), np.sort(forces)[::-1])
axes.set_xlabel("chords, the strongest first")
axes.set_ylabel("force [N]")
figure.tight_layout()
