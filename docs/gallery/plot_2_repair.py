"""
A flail leaflet, and a clip
===========================

The chords of one leaflet are cut, as a rupture does, and it rises above the annulus; then a clip joins the edges. Three
scenes that differ in their interventions.
"""
# %%
# The scene is a dict with the keys of a scene file; the mesh is that of the generated valve.
import pathlib
import tempfile

from matplotlib import pyplot

import coapt

folder = pathlib.Path(tempfile.mkdtemp())
coapt.generate_mitral(folder, triangles=600, preset="benchmark")
scene = {
    "mesh": {"file": folder / "leaflets.obj", "sets": folder / "valve.json"},
    "boundary": [
        {"nodes": "annulus", "move_to": "annulus_closed"},
        {"nodes": "papillary", "move_to": "papillary_closed"},
    ],
    "terms": [
        {"type": "cst_tension_field", "name": "leaflets", "young": "1 MPa", "poisson": 0.45,
         "thickness": "0.8 mm"},
        {"type": "bending"},
        {"type": "cable", "name": "chords", "network": folder / "valve.json", "young": "40 MPa"},
        {"type": "load_pressure", "value": "120 mmHg", "model": "follower", "side": "front"},
        {"type": "contact_barrier"},
    ],
    "solver": {"type": "newton", "tolerance": 1e-6},
}
healthy = coapt.solve(scene)
print(healthy)

# %%
# All chords of the posterior leaflet go, by their numbers in the network.
posterior = [*range(20, 44), *range(70, 94)]
rupture = {"type": "chord_cut", "chords": posterior}
ruptured = coapt.solve({**scene, "interventions": [rupture]})
print(ruptured)

# %%
# A clip in the middle of the free edge.
clip = {"type": "clip", "at": [0.5], "width": "5 mm", "depth": "6 mm"}
clipped = coapt.solve({**scene, "interventions": [rupture, clip]})
print(clipped)

# %%
# From the side, coloured by height: the flail leaflet stands above the annulus until the clip holds it.
valves = {"healthy": healthy, "chords cut": ruptured, "and a clip": clipped}
figure, axes = pyplot.subplots(1, 3, figsize=(12, 4.5))
for ax, (name, result) in zip(axes, valves.items()):
    coapt.plot.shape(result, color=result.x[:, 2], view=(25, -90), ax=ax)
    ax.set_title(f"{name}\nprolapse {result.metrics['prolapse_height_mm']:.1f} mm")
figure.tight_layout()

# %%
# What else the repair changes.
for name, result in valves.items():
    print(f"{name:12} coaptation height {result.metrics['coaptation_height_mm']:.1f} mm, "
          f"strongest chord {result.metrics['max_chord_force_n']:.2f} N")
