#!/usr/bin/env python3
"""How near `coapt segment` comes to the leaflets of phantoms, whose truth is known.

    bench/image.py [path of coapt] [--seeds N] [--case NAME ...] [-o FILE.csv]

Generates mitral valves of seeds 1 to N, makes an ultrasound-like volume of each (`coapt phantom`), looks for the leaflets
in it and compares them with the surface that the volume was made of. Prints a Markdown table: the median over all seeds and
the worst of them; with -o also a row for each volume.
"""
import argparse
import csv
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from typing import NamedTuple

Point = tuple[float, float, float]


class Case(NamedTuple):
    voxel: str
    psf: list[str]
    dropout: float
    shadows: int
    goals: dict[str, float]


CASES = {
    "fine": Case("0.5mm", ["0.5mm", "0.5mm"], 0, 0,
                 {"to_truth_mean": 0.25, "to_truth_p95": 0.8, "from_truth_mean": 0.25, "from_truth_p95": 0.8}),
    "coarse": Case("0.7mm", ["0.8mm", "0.8mm"], 0.15, 0,
                   {"to_truth_mean": 0.45, "to_truth_p95": 1.3, "from_truth_mean": 0.45, "from_truth_p95": 1.3}),
    "sector": Case("0.5mm", ["0.6mm", "0.9mm"], 0.15, 2, {}),
}
COMMON = {"area_percent": 5, "free_edge_mean": 0.8, "annulus_mean": 1.0, "thickness_percent": 20, "cpu_s": 60}
TRUE_THICKNESS = 1.0  # mm
NEAR_EDGE = 2.0  # mm: there the place along the leaflet is in doubt, which the deviation across it does not know


def command(coapt: str, *arguments: str) -> None:
    done = subprocess.run([coapt, *arguments], capture_output=True, text=True, check=False)
    if done.returncode == 2 or done.returncode == 3:
        raise SystemExit(f"{' '.join(arguments)}: {done.stderr}")


def obj(path: pathlib.Path) -> tuple[list[Point], list[tuple[int, int, int]]]:
    points: list[Point] = []
    triangles: list[tuple[int, int, int]] = []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append((float(words[1]), float(words[2]), float(words[3])))
        elif words[:1] == ["f"]:
            a, b, c = (int(word.split("/")[0]) - 1 for word in words[1:4])
            triangles.append((a, b, c))
    return points, triangles


def vtp_array(path: pathlib.Path, name: str) -> list[float]:
    """A scalar of 64 bits from the raw appended data of a VTP as Coapt writes it."""
    data = path.read_bytes()
    begin = data.index(b"<AppendedData")
    header = xml.fromstring(data[:begin] + b"</VTKFile>")
    offset = next(int(entry.attrib["offset"]) for entry in header.iter("DataArray") if entry.get("Name") == name)
    start = data.index(b"_", begin) + 1 + offset
    (size,) = struct.unpack_from("<Q", data, start)
    return list(struct.unpack_from(f"<{size // 8}d", data, start + 8))


def markup(path: pathlib.Path) -> list[Point]:
    points = json.loads(path.read_text())["markups"][0]["controlPoints"]
    return [tuple(point["position"]) for point in points]


def to_segment(p: Point, a: Point, b: Point) -> float:
    along = [b[k] - a[k] for k in range(3)]
    squared = sum(x * x for x in along)
    part = sum((p[k] - a[k]) * along[k] for k in range(3)) / squared if squared > 0 else 0
    part = min(max(part, 0), 1)
    return math.dist(p, [a[k] + part * along[k] for k in range(3)])


def loop_distance(points: list[Point], loop: list[Point]) -> float:
    """Mean distance of points from a closed polygon."""
    edges = list(zip(loop, loop[1:] + loop[:1]))
    return sum(min(to_segment(p, a, b) for a, b in edges) for p in points) / len(points)


def both_ways(a: list[Point], b: list[Point]) -> float:
    return 0.5 * (loop_distance(a, b) + loop_distance(b, a))


def to_triangle(p: Point, a: Point, b: Point, c: Point) -> float:
    """Distance from a triangle: from its plane where the foot lies inside, else from its edges."""
    u = [b[k] - a[k] for k in range(3)]
    v = [c[k] - a[k] for k in range(3)]
    w = [p[k] - a[k] for k in range(3)]
    n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    squared = sum(x * x for x in n)
    if squared > 0:
        cross = lambda s, t: (s[1] * t[2] - s[2] * t[1]) * n[0] + (s[2] * t[0] - s[0] * t[2]) * n[1] + (
            s[0] * t[1] - s[1] * t[0]) * n[2]
        beta, gamma = cross(w, v) / squared, cross(u, w) / squared
        if beta >= 0 and gamma >= 0 and beta + gamma <= 1:
            return abs(sum(w[k] * n[k] for k in range(3))) / math.sqrt(squared)
    return min(to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a))


def coverage(found: pathlib.Path, truth: tuple[list[Point], list[tuple[int, int, int]]], edge: list[Point]) -> float:
    """Share of the vertices away from the free edge that lie within twice their stated deviation of the truth."""
    points, _ = obj(found / "leaflets.obj")
    deviation = vtp_array(found / "leaflets.vtp", "deviation_mm")
    around: list[list[int]] = [[] for _ in truth[0]]
    for number, triangle in enumerate(truth[1]):
        for corner in triangle:
            around[corner].append(number)
    inner = within = 0
    for p, allowed in zip(points, deviation):
        if min(math.dist(p, q) for q in edge) < NEAR_EDGE:
            continue
        nearest = sorted(range(len(truth[0])), key=lambda v: math.dist(p, truth[0][v]))[:4]
        near = {t for v in nearest for t in around[v]}
        distance = min(to_triangle(p, *(truth[0][corner] for corner in truth[1][t])) for t in near)
        inner += 1
        within += distance <= 2 * allowed
    return within / inner


def loops_of(triangles: list[tuple[int, int, int]]) -> int:
    """Number of closed rims."""
    edges = {(t[k], t[(k + 1) % 3]) for t in triangles for k in range(3)}
    following = {a: b for a, b in edges if (b, a) not in edges}
    loops = 0
    while following:
        at = next(iter(following))
        while at in following:
            at = following.pop(at)
        loops += 1
    return loops


def measure(coapt: str, case: Case, seed: int, folder: pathlib.Path) -> dict[str, float]:
    command(coapt, "generate", "mitral", "--seed", str(seed), "--triangles", "2500", "-o", str(folder / "valve"))
    command(coapt, "phantom", str(folder / "valve/scene.json"), "--voxel", case.voxel, "--psf", *case.psf, "--dropout",
            str(case.dropout), "--shadows", str(case.shadows), "--thickness", f"{TRUE_THICKNESS}mm", "--seed", str(seed),
            "-o", str(folder / "phantom"))
    truth, found = folder / "phantom/open", folder / "found"
    command(coapt, "segment", str(truth / "image.nrrd"), "--annulus", str(truth / "annulus.mrk.json"), "--dynamic-range",
            "50", "-o", str(found))
    command(coapt, "register", str(found / "leaflets.obj"), str(truth / "surface.obj"), "--method", "surface", "-o",
            str(folder / "registered"))
    apart = json.loads((folder / "registered/registration.json").read_text())["distances_before"]
    figures = json.loads((found / "segmentation.json").read_text())
    valve = json.loads((found / "valve.json").read_text())
    points, triangles = obj(found / "leaflets.obj")
    surface = obj(truth / "surface.obj")
    edge, ring = markup(truth / "free_edge.mrk.json"), markup(truth / "annulus.mrk.json")
    found_edge = [points[v] for v in valve["free_edge"]]
    area = sum(0.5 * math.hypot(*cross_of(surface[0], t)) for t in surface[1])
    return {
        "to_truth_mean": apart["to_target"]["mean_mm"], "to_truth_p95": apart["to_target"]["p95_mm"],
        "from_truth_mean": apart["from_target"]["mean_mm"], "from_truth_p95": apart["from_target"]["p95_mm"],
        "area_percent": 100 * abs(figures["area_mm2"] / area - 1),
        "free_edge_mean": both_ways(found_edge, edge),
        "annulus_mean": both_ways([points[v] for v in valve["annulus"]], ring),
        "loops": loops_of(triangles), "least_angle_deg": figures["least_angle_deg"],
        "thickness_percent": 100 * abs(figures["thickness_mm"]["median"] / TRUE_THICKNESS - 1),
        "coverage_2_sd": coverage(found, surface, found_edge),
        "voxels": math.prod(figures["voxels"]), "cpu_s": figures["cpu_seconds"],
    }


def cross_of(points: list[Point], triangle: tuple[int, int, int]) -> list[float]:
    a, b, c = (points[corner] for corner in triangle)
    u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def print_table(name: str, case: Case, rows: list[dict[str, float]]) -> None:
    print(f"\n{name}: voxels of {case.voxel}, spread {' along and '.join(case.psf)} across the beam, "
          f"{100 * case.dropout:.0f} % dropout, {case.shadows} shadows; {len(rows)} valves\n")
    print("| | median | worst | goal | met by |\n|---|---|---|---|---|")
    goals = case.goals | COMMON
    for key in rows[0]:
        values = sorted(row[key] for row in rows)
        is_floor = key in ("least_angle_deg", "coverage_2_sd")
        goal = 20 if key == "least_angle_deg" else goals.get(key)
        met = "" if goal is None else sum((v >= goal) if is_floor else (v <= goal) for v in values)
        worst = values[0] if is_floor else values[-1]
        print(f"| {key} | {values[len(values) // 2]:.3g} | {worst:.3g} | {'' if goal is None else goal} | {met} |")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/ci/bin/coapt")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--case", action="append", choices=CASES)
    parser.add_argument("-o", "--output", type=pathlib.Path)
    options = parser.parse_args()
    kept = []
    for name in options.case or CASES:
        rows = []
        for seed in range(1, options.seeds + 1):
            with tempfile.TemporaryDirectory() as folder:
                rows.append(measure(options.coapt, CASES[name], seed, pathlib.Path(folder)))
            print(name, seed, {key: round(value, 3) for key, value in rows[-1].items()}, file=sys.stderr)
            kept.append({"case": name, "seed": seed} | rows[-1])
        print_table(name, CASES[name], rows)
    if options.output:
        with options.output.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, list(kept[0]))
            writer.writeheader()
            writer.writerows(kept)


if __name__ == "__main__":
    main()
