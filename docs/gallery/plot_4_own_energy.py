"""
An energy of one's own
======================

A term is its formula for one element. SymPy differentiates it, NumPy evaluates it, and it stands beside the terms of the
library; the same formula becomes a kernel in C++.
"""
# %%
# A flat disc of rubber in a frame, 20 mm wide.
import numpy as np

import coapt

rings, radius = 8, 10.0
places, F, first = [[0.0, 0.0, 0.0]], [], 0
for ring in range(1, rings + 1):  # of 6, 12, 18, ... vertices
    inner, first, count = first, len(places), 6 * ring
    inner_count = max(1, count - 6)
    for k in range(count):
        angle, (side, step) = 2 * np.pi * k / count, divmod(k, ring)
        places.append([radius * ring / rings * np.cos(angle), radius * ring / rings * np.sin(angle), 0])
        here = inner + (side * (ring - 1) + step) % inner_count
        after = inner + (side * (ring - 1) + step + 1) % inner_count
        F += [[first + k, first + (k + 1) % count, here]]
        F += [[here, first + (k + 1) % count, after]] if step + 1 < ring else []
V, F = np.array(places), np.array(F)

# %%
# The neo-Hookean membrane that the library calls ``cst_neo_hookean``: metrics of the triangle at rest and now, and from
# them the first invariant of an incompressible sheet.
rubber = coapt.energy("""G = gram(X1 - X0, X2 - X0)
                         g = gram(x1 - x0, x2 - x0)
                         invariant = trace(inverse(G) * g) + det(G) / det(g)
                         h * sqrt(det(G)) / 2 * mu / 2 * (invariant - 3)""",
                      F, X=V, mu=0.3, h=0.2, name="rubber")
report = coapt.check_term(rubber, 1.1 * V + 0.1 * np.sin(np.arange(V.size)).reshape(V.shape))
print(f"slopes of the remainders: {report['gradient_slope']:.3f} and {report['hessian_slope']:.3f}; 2 and 3 are right")

# %%
# A ball, 6 mm wide, is pressed into it: a penalty at each vertex, smooth where the ball ends. And strings from a point above
# to the middle, which pull once they are longer than 9 mm.
every, middle = np.arange(len(V))[:, None], np.arange(19)[:, None]
ball = coapt.energy("k * max(r - norm(x0 - c), 0)**3", every, k=0.5, r=3,
                    c=np.tile([4.0, 0, 1.5], (len(V), 1)), name="ball", role="contact")
strings = coapt.energy("t * max(norm(x0 - top) - 9, 0)**2", middle, t=0.02,
                       top=np.tile([-2.0, 0, 12], (19, 1)), name="strings", role="load")
result = coapt.minimize(V, F, [rubber, ball, strings], fixed="boundary", tol=1e-8)
result

# %%
# Coloured by the energy of each triangle, which the term gives element by element.
coapt.plot.shape(result, color=rubber.element_energies(result.x), view=(20, -60))

# %%
# The library's own law finds the same shape,
theirs = {"type": "cst_neo_hookean", "shear_modulus": "0.3 MPa", "thickness": "0.2 mm",
          "compression": "resisted"}
same = coapt.minimize(V, F, [theirs, ball, strings], fixed="boundary", tol=1e-8)
difference = np.abs(same.x - result.x).max()
print(f"greatest distance {difference:.1e} mm")

# %%
# and this is the beginning of the formula as a kernel in C++.
kernel = rubber.kernel("Rubber")
print(kernel[:kernel.index("static Rest")])
