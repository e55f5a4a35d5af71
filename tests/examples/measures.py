"""Reads a result folder and measures it, with nothing but the standard library and none of Coapt's code."""
import math
import pathlib
import re
import struct

AXES = {"x": 0, "y": 1, "z": 2}


class Outcome:
    """Closed and start positions of all nodes (chord junctions included) and the triangles of the surface."""

    def __init__(self, folder: pathlib.Path):
        self.closed, displacement = read_points(folder / "closed.vtp")
        self.start = [[c - d for c, d in zip(p, u)] for p, u in zip(self.closed, displacement)]
        surface = folder / "closed.obj"  # a scene without a mesh has none
        lines = surface.read_text().splitlines() if surface.exists() else []
        faces = (line.split()[1:4] for line in lines if line[:2] == "f ")
        self.triangles = [[int(corner.split("/")[0]) - 1 for corner in face] for face in faces]

    def node(self, start: list[float]) -> int:
        """The node that started nearest to a point."""
        return min(range(len(self.start)), key=lambda i: math.dist(self.start[i], start))


def read_points(path: pathlib.Path) -> tuple[list, list]:
    """Points and displacements of a VTP file with raw appended data and 64-bit headers."""
    content = path.read_bytes()
    blocks = content.index(b"_", content.index(b"<AppendedData")) + 1
    header = content[:blocks].decode()

    def array(name: str) -> list[list[float]]:
        found = re.search(rf'type="Float64" Name="{name}" NumberOfComponents="3" format="appended" offset="(\d+)"', header)
        at = blocks + int(found.group(1))
        (size,) = struct.unpack_from("<Q", content, at)
        return [list(entry) for entry in struct.iter_unpack("<3d", content[at + 8:at + 8 + size])]

    return array("Points"), array("displacement")


def rim_between(outcome: Outcome, first: int, last: int) -> list[int]:
    """The nodes of the rim from one node to another, in the direction in which its triangles run."""
    edges = {(t[k], t[(k + 1) % 3]) for t in outcome.triangles for k in range(3)}
    following = {a: b for a, b in edges if (b, a) not in edges}
    nodes = [first]
    while nodes[-1] != last:
        nodes.append(following[nodes[-1]])
        if len(nodes) > len(following):
            raise ValueError("the two nodes are not on one rim")
    return nodes


def circumradius(a: list[float], b: list[float], c: list[float]) -> float:
    ab, bc, ca = math.dist(a, b), math.dist(b, c), math.dist(c, a)
    half = (ab + bc + ca) / 2
    return ab * bc * ca / 4 / math.sqrt(half * (half - ab) * (half - bc) * (half - ca))


def edge_radii(outcome: Outcome, corners: list[list[float]]) -> list[float]:
    """Radius of the circle through each three consecutive nodes of the rim between two corners."""
    rim = [outcome.closed[i] for i in rim_between(outcome, *(outcome.node(c) for c in corners))]
    return [circumradius(*rim[i - 1:i + 2]) for i in range(1, len(rim) - 1)]


def edge_sag(outcome: Outcome, corners: list[list[float]]) -> float:
    """Greatest distance of the rim between two corners from the straight line through them."""
    rim = [outcome.closed[i] for i in rim_between(outcome, *(outcome.node(c) for c in corners))]
    span = math.dist(rim[0], rim[-1])
    along = [(b - a) / span for a, b in zip(rim[0], rim[-1])]

    def distance(point: list[float]) -> float:
        arm = [p - a for p, a in zip(point, rim[0])]
        foot = sum(u * v for u, v in zip(arm, along))
        return math.dist(arm, [foot * v for v in along])

    return max(map(distance, rim))


def measured(what: dict, result: dict, outcome: Outcome) -> float:
    """The number that one entry of expected.json asks for; examples/README.md lists the kinds."""
    if "metric" in what:
        value = result
        for key in what["metric"].split("."):
            value = value[key]
        return value
    if "position" in what:
        return outcome.closed[outcome.node(what["position"])][AXES[what["axis"]]]
    if "displacement" in what:
        node = outcome.node(what["displacement"])
        return outcome.closed[node][AXES[what["axis"]]] - outcome.start[node][AXES[what["axis"]]]
    if "lowest" in what:
        return min(point[AXES[what["lowest"]]] for point in outcome.closed)
    if "edge_radius" in what:
        radii = edge_radii(outcome, what["edge_radius"])
        return {"mean": sum(radii) / len(radii), "least": min(radii), "greatest": max(radii)}[what["of"]]
    if "edge_sag" in what:
        return edge_sag(outcome, what["edge_sag"])
    raise KeyError(f"expected.json: no measure in {what}")
