"""A mitral valve closes under systolic pressure. Cells (# %%) run in any notebook, the file as it is too."""
# %% Solve the scene of examples/01_mitral_valve.
import pathlib

import numpy as np

import coapt
from coapt import plot

examples = pathlib.Path(__file__).resolve().parents[1]
result = coapt.solve(examples / "01_mitral_valve/scene.json")
print(result)

# %% Is it closed, and what do the chords bear?
for name in ("orifice_area_mm2", "coaptation_length_mm", "tenting_height_mm", "max_principal_strain"):
    print(f"{name:24} {result.metrics[name]:.4g}")
touching = result.fields["is_contact"].mean()
strongest = result.fields["line_force"].max()
print(f"{100 * touching:.0f} % of the vertices touch; the strongest chord pulls with {strongest:.2f} N")

# %% Which chords pull most, and where do they end?
order = np.argsort(result.fields["line_force"])[::-1][:5]
for chord in order:
    a, b = result.lines[chord]
    print(f"chord {chord}: {result.fields['line_force'][chord]:.2f} N from {result.x[a].round(1)} to {result.x[b].round(1)} mm")

# %% How it got there.
axes = plot.convergence(result)
axes.figure.savefig("closure.png")
