"""
A study with exact slopes
=========================

How does the opening of a valve depend on the length of its chords? A followed equilibrium is solved again by warm Newton
steps, and says how each figure changes without another solve.
"""
# %%
# Parameters are named; ``eq.available`` lists all of them.
import pathlib
import tempfile

import numpy as np
from matplotlib import pyplot

import coapt

folder = pathlib.Path(tempfile.mkdtemp())
eq = coapt.Equilibrium(coapt.generate_mitral(folder, triangles=600, preset="benchmark"), ["chords.length"])
first = eq.solve()
print(first.message)
eq

# %%
# The smooth figures of ``coapt.metrics`` have derivatives.
figures = {"coaptation area [mm²]": coapt.metrics.coaptation_area(eq),
           "largest chord force [N]": coapt.metrics.line_force_norm(eq, "chords")}

# %%
# Along the sweep each point has a value and a slope; steps are warm.
lengths = np.linspace(0.99, 1.01, 9)
values = {name: [] for name in figures}
steps = []
for length in lengths:
    eq["chords.length"] = length
    steps.append(eq.solve().iterations)
    for name, metric in figures.items():
        values[name].append(eq.value_and_grad(metric))
print("Newton steps:", steps)

# %%
# The slopes are tangents of the curve, each from its own point alone.
figure, axes = pyplot.subplots(1, 2, figsize=(9, 3.2))
for ax, (name, points) in zip(axes, values.items()):
    ax.plot(lengths, [value for value, _ in points], "o", color="tab:blue")
    for length, (value, slope) in zip(lengths, points):
        reach = np.array([-0.001, 0.001])
        ax.plot(length + reach, value + slope[0] * reach, color="tab:orange")
    ax.set_xlabel("factor on the lengths of the chords")
    ax.set_ylabel(name)
figure.tight_layout()
