"""A mainsail in a breeze: a wrinkling cloth between mast, boom and leech line; with an energy of one's own."""
# %% The sail: luff of 6 m along the mast (z), foot of 2.5 m (x); a grid in barycentric coordinates. Lengths in mm.
import numpy as np

import coapt

cells, luff, foot = 14, 6000.0, 2500.0
number, V = {}, []
for i in range(cells + 1):
    for j in range(cells + 1 - i):
        number[i, j] = len(V)
        V.append([foot * j / cells, 0.0, luff * i / cells])
V = np.array(V)
F = [[number[i, j], number[i, j + 1], number[i + 1, j]] for i in range(cells) for j in range(cells - i)]
F += [[number[i, j + 1], number[i + 1, j + 1], number[i + 1, j]] for i in range(cells - 1) for j in range(cells - 1 - i)]
mast = [number[i, 0] for i in range(cells + 1)]
clew = number[0, cells]
leech = np.array([[number[i, cells - i], number[i + 1, cells - i - 1]] for i in range(cells)])


# %% The leech line as an energy in Python: a stiff cord that pulls when it is longer than the leech was.
class LeechLine(coapt.Term):
    elements = leech
    stiffness = 2e3  # tension over strain [N]

    def strain(self, x):
        along = x[leech[:, 1]] - x[leech[:, 0]]
        length = np.linalg.norm(along, axis=1)
        rest = np.linalg.norm(V[leech[:, 1]] - V[leech[:, 0]], axis=1)
        return along / length[:, None], length, rest, np.maximum(length / rest - 1, 0)

    def value(self, x):
        _, _, rest, strain = self.strain(x)
        return 0.5 * self.stiffness * (rest * strain**2).sum()

    def gradient(self, x):
        unit, _, _, strain = self.strain(x)
        gradient = np.zeros_like(x)
        np.add.at(gradient, leech[:, 1], self.stiffness * strain[:, None] * unit)
        np.subtract.at(gradient, leech[:, 0], self.stiffness * strain[:, None] * unit)
        return gradient

    def hessian(self, x):
        unit, length, rest, strain = self.strain(x)
        outer = unit[:, :, None] * unit[:, None, :]
        along, across = (strain > 0) / rest, strain / length
        block = self.stiffness * ((along - across)[:, None, None] * outer + across[:, None, None] * np.eye(3))
        return np.block([[block, -block], [-block, block]])


assert coapt.check_term(LeechLine(), 1.1 * V + 0.01 * np.sin(np.arange(V.size)).reshape(V.shape))["passed"]

# %% Cloth that bears no compression, and the wind: 60 Pa on its windward side.
cloth = {"type": "cst_tension_field", "young": "300 MPa", "poisson": 0.3, "thickness": "0.25 mm"}
wind = {"type": "load_pressure", "value": "60 Pa"}
result = coapt.minimize(V, F, [cloth, LeechLine(), wind], fixed=[*mast, clew], tol=1e-6)
print(result)

# %% Draft: greatest depth of the section at a third of the height, over its chord.
height = 5
section = result.x[[number[height, j] for j in range(cells + 1 - height)]]
chord = section[-1] - section[0]
offset = section - section[0]
depth = np.linalg.norm(offset - np.outer(offset @ chord, chord) / (chord @ chord), axis=1).max()
draft = depth / np.linalg.norm(chord)
clew_force = np.linalg.norm(result.reactions[clew])
slack = (result.fields["regime"] == 0).mean()
print(f"draft {100 * draft:.1f} %, {clew_force:.0f} N at the clew, {100 * slack:.0f} % of the cloth is slack")
