"""Scenes of bench/estimates.py that `coapt generate` does not have. Lengths in mm."""
import json
import math


def obj(count_u, count_v, place, is_ring=False, is_triangle=False):
    """Text of a mesh over 0 <= u, v <= 1 with crossing diagonals; closed along u, or its half u + v <= 1."""
    columns = count_u if is_ring else count_u + 1
    number, vertices, facets = {}, [], []
    for j in range(count_v + 1):
        for i in range(columns if not is_triangle else count_u + 1 - j):
            vertices.append(place(i / count_u, j / count_v))
            number[i, j] = len(vertices)
    for j in range(count_v):
        for i in range(count_u):
            a, b, c, d = [number.get(((i + di) % columns, j + dj)) for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))]
            if is_triangle:
                facets += [f for f in ((a, b, d), (b, c, d)) if all(f)]
            else:
                facets += [(a, b, c), (a, c, d)] if (i + j) % 2 == 0 else [(a, b, d), (b, c, d)]
    return "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices) + "".join(f"f {a} {b} {c}\n" for a, b, c in facets)


def scene(boundary, *terms):
    return json.dumps({"mesh": {"file": "mesh.obj"}, "boundary": boundary, "terms": list(terms),
                       "solver": {"type": "newton", "tolerance": 1e-8, "max_iterations": 2000}})


RIM = [{"nodes": "boundary", "fix": True}]


def cylinder():
    """Rubber tube between end plates, blown up."""
    return (obj(12, 6, lambda u, v: (20 * math.cos(2 * math.pi * u), 20 * math.sin(2 * math.pi * u), 60 * v), is_ring=True),
            scene(RIM, {"type": "cst_neo_hookean", "shear_modulus": "0.3 MPa", "thickness": "0.5 mm"},
                  {"type": "load_pressure", "value": "3 kPa"}))


def pane():
    """Rubber sheet over a rectangular hole, blown up."""
    return (obj(6, 4, lambda u, v: (120 * u, 80 * v, 0.0)),
            scene(RIM, {"type": "cst_neo_hookean", "shear_modulus": "0.3 MPa", "thickness": "0.5 mm"},
                  {"type": "load_pressure", "value": "2 kPa"}))


def catenoid():
    """Film between two rings."""
    return (obj(12, 4, lambda u, v: (10 * math.cos(2 * math.pi * u), 10 * math.sin(2 * math.pi * u), 11 * v), is_ring=True),
            scene(RIM, {"type": "surface_tension", "tension": "1 N/mm"}))


def sail():
    """Triangle of cloth in the wind, held along its luff and its foot."""
    return (obj(8, 8, lambda u, v: (2000 * u, 0.0, 4000 * v), is_triangle=True),
            scene([{"nodes": {"plane": {"axis": "x", "at": 0}}, "fix": True},
                   {"nodes": {"plane": {"axis": "z", "at": 0}}, "fix": True}],
                  {"type": "cst_stvk", "young": "500 MPa", "poisson": 0.3, "thickness": "0.3 mm", "prestress": "0.5 N/mm"},
                  {"type": "load_pressure", "value": "100 Pa"}))


def blown(place, u, v, pressure, **kind):
    """Rubber sheet held at its rim under pressure."""
    return (obj(u, v, place, **kind),
            scene(RIM, {"type": "cst_neo_hookean", "shear_modulus": "0.3 MPa", "thickness": "0.5 mm"},
                  {"type": "load_pressure", "value": pressure}))


def ring():
    """Rubber ring between two circles, blown up."""
    return blown(lambda u, v: ((20 + 30 * v) * math.cos(2 * math.pi * u), (20 + 30 * v) * math.sin(2 * math.pi * u), 0.0),
                 12, 3, "3 kPa", is_ring=True)


def bent():
    """Rubber sheet over the hole of a quarter of a torus in plan, with an edge that turns in."""
    return blown(lambda u, v: ((30 + 40 * v) * math.cos(1.5 * math.pi * u), (30 + 40 * v) * math.sin(1.5 * math.pi * u), 0.0),
                 12, 4, "3 kPa")


def dome():
    """Rubber cap of half a sphere with a hole at its top, blown up."""
    def place(u, v):
        polar = 0.5 * math.pi * (1 - 0.8 * v)
        return (30 * math.sin(polar) * math.cos(2 * math.pi * u), 30 * math.sin(polar) * math.sin(2 * math.pi * u),
                30 * math.cos(polar))
    return blown(place, 12, 4, "4 kPa", is_ring=True)


def cone():
    """Prestressed cloth between a high ring and a low one, under snow."""
    return (obj(16, 4, lambda u, v: ((400 + 1600 * v) * math.cos(2 * math.pi * u), (400 + 1600 * v) * math.sin(2 * math.pi * u),
                                     1200 * (1 - v)), is_ring=True),
            scene(RIM, {"type": "cst_stvk", "young": "500 MPa", "poisson": 0.3, "thickness": "0.8 mm", "prestress": "4 N/mm"},
                  {"type": "load_pressure", "value": "600 Pa", "side": "back"}))


def saddle():
    """Prestressed cloth over a skew square, in the wind."""
    return (obj(6, 6, lambda u, v: (4000 * u, 4000 * v, 1500 * (2 * u - 1) * (2 * v - 1))),
            scene(RIM, {"type": "cst_stvk", "young": "500 MPa", "poisson": 0.3, "thickness": "0.8 mm", "prestress": "4 N/mm"},
                  {"type": "load_pressure", "value": "800 Pa"}))


SCENES = {make.__name__: make for make in (cylinder, pane, catenoid, sail, ring, bent, dome, cone, saddle)}
