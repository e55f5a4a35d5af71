#!/usr/bin/env python3
"""How near `coapt segment` comes to the leaflets of phantoms, whose truth is known.

    bench/image.py [path of coapt] [--seeds N] [--case NAME ...] [--method NAME] [--edge NAME] [-o FILE.csv]

Generates mitral valves of seeds 0 to N - 1, solves them, makes ultrasound-like volumes of each (`coapt phantom`), looks for the
leaflets in that of the open valve, compares them with the surface that it was made of, closes them (`coapt close`), and compares the
closed valve with the one that was imaged. Prints a Markdown table for bench/tables.py: the median over all seeds, the worst of them,
and how many meet the goal; with -o also a row for each volume. Volumes at 0.7 mm have 15 % dropout. --method is that of `segment`, --edge that
of `segment` and `close`.
"""
import argparse
import csv
import gzip
import json
import math
import os
import pathlib
import statistics
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
COMMON = {"area_percent": 5, "free_edge_mean": 0.8, "annulus_mean": 1.0, "loops": 2, "least_angle_deg": 20, "thickness_percent": 20,
          "dice_atrium": 0.95, "dice_ventricle": 0.95, "coverage_2_sd": 0.8, "closed": 1, "closed_to_truth_mean": 0.6,
          "closed_from_truth_mean": 0.6, "orifice_error_mm2": 15, "cpu_s": 60}
FLOORS = ("least_angle_deg", "dice_atrium", "dice_ventricle", "coverage_2_sd", "coverage_2_sd_gaps", "closed")  # the more the better
NAMES = {
    "to_truth_mean": "found to truth, mean [mm]", "to_truth_p95": "found to truth, 95 % [mm]",
    "from_truth_mean": "truth to found, mean [mm]", "from_truth_p95": "truth to found, 95 % [mm]", "area_percent": "area, off by [%]",
    "free_edge_mean": "free edge, mean both ways [mm]", "annulus_mean": "annulus, mean both ways [mm]",
    "loops": "closed rims", "bad_edges": "edges of more than two triangles", "least_angle_deg": "least angle [degrees]",
    "thickness_percent": "median thickness, off by [%]", "dice_atrium": "Dice of the atrium", "dice_ventricle": "Dice of the ventricle",
    "coverage_2_sd": "within two stated deviations, share", "coverage_2_sd_gaps": "the same in dropout",
    "closed": "closes to a converged valve", "closed_to_truth_mean": "closed: found to truth, mean [mm]",
    "closed_to_truth_p95": "closed: found to truth, 95 % [mm]", "closed_from_truth_mean": "closed: truth to found, mean [mm]",
    "closed_from_truth_p95": "closed: truth to found, 95 % [mm]", "orifice_error_mm2": "closed: orifice, off by [mm²]",
    "voxels": "voxels looked at", "cpu_s": "segment: processor time [s]", "peak_mb": "segment: memory [MB]",
}
TRUE_THICKNESS = 1.0  # mm
NEAR_EDGE = 2.0  # mm: there the place along the leaflet is in doubt, which the deviation across it does not know


def command(coapt: str, *arguments: str, may_fail: bool = False) -> tuple[int, float]:
    """Exit code, and the greatest memory [MB]."""
    with tempfile.TemporaryFile("w+") as said, subprocess.Popen([coapt, *arguments], stdout=said, stderr=said) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode not in (0, 1, 4) and not may_fail:
            said.seek(0)
            raise SystemExit(f"{' '.join(arguments)}: {said.read()}")
        return process.returncode, usage.ru_maxrss / 1024


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
    """A scalar from the raw appended data of a VTP as Coapt writes it."""
    data = path.read_bytes()
    begin = data.index(b"<AppendedData")
    header = xml.fromstring(data[:begin] + b"</VTKFile>")
    entry = next(entry for entry in header.iter("DataArray") if entry.get("Name") == name)
    start = data.index(b"_", begin) + 1 + int(entry.attrib["offset"])
    (size,) = struct.unpack_from("<Q", data, start)
    kind, width = {"Float64": ("d", 8), "Int32": ("i", 4)}[entry.attrib["type"]]
    return list(struct.unpack_from(f"<{size // width}{kind}", data, start + 8))


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


def coverage(found: pathlib.Path, truth: tuple[list[Point], list[tuple[int, int, int]]], edge: list[Point],
             dropout: list[float]) -> tuple[float, float]:
    """Share of the vertices away from the free edge that lie within twice their stated deviation of the truth; of those in dropout."""
    points, _ = obj(found / "leaflets.obj")
    deviation = vtp_array(found / "leaflets.vtp", "deviation_mm")
    around: list[list[int]] = [[] for _ in truth[0]]
    for number, triangle in enumerate(truth[1]):
        for corner in triangle:
            around[corner].append(number)
    inner = within = in_gaps = within_gaps = 0
    for p, allowed in zip(points, deviation):
        if min(math.dist(p, q) for q in edge) < NEAR_EDGE:
            continue
        nearest = sorted(range(len(truth[0])), key=lambda v: math.dist(p, truth[0][v]))[:4]
        near = {t for v in nearest for t in around[v]}
        distance, nearest_triangle = min((to_triangle(p, *(truth[0][corner] for corner in truth[1][t])), t) for t in near)
        inner += 1
        within += distance <= 2 * allowed
        if dropout[nearest_triangle] > 0.5:
            in_gaps += 1
            within_gaps += distance <= 2 * allowed
    return within / inner, within_gaps / in_gaps if in_gaps else math.nan


class Grid(NamedTuple):
    size: list[int]
    origin: list[float]
    axes: list[list[float]]  # steps along i, j, k, orthogonal
    values: bytes

    def label(self, p: list[float]) -> int:
        """Of the nearest voxel; 0 outside."""
        at = 0
        for axis in (2, 1, 0):
            step = self.axes[axis]
            place = round(sum((p[k] - self.origin[k]) * step[k] for k in range(3)) / sum(x * x for x in step))
            if not 0 <= place < self.size[axis]:
                return 0
            at = at * self.size[axis] + place
        return self.values[at]


def labels(path: pathlib.Path) -> Grid:
    """A NRRD of bytes, packed, in LPS, as `coapt phantom` writes it."""
    head, data = path.read_bytes().split(b"\n\n", 1)
    fields = dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line)
    vector = lambda text: [float(x) for x in text.strip("()").split(",")]
    return Grid([int(x) for x in fields["sizes"].split()], vector(fields["space origin"]),
                [vector(word) for word in fields["space directions"].split()], gzip.decompress(data))


def cavity_dice(truth: Grid, found: Grid) -> list[float]:
    """Of atrium and ventricle, over every eighth voxel that is blood in both."""
    pairs = []
    for k in range(0, truth.size[2], 2):
        for j in range(0, truth.size[1], 2):
            start = (k * truth.size[1] + j) * truth.size[0]
            for i in range(0, truth.size[0], 2):
                if truth.values[start + i] not in (1, 2):
                    continue
                p = [truth.origin[n] + sum(c * truth.axes[axis][n] for axis, c in enumerate((i, j, k))) for n in range(3)]
                if (other := found.label(p)) in (1, 2):
                    pairs.append((truth.values[start + i], other))
    return [2 * pairs.count((what, what)) / sum((a == what) + (b == what) for a, b in pairs) for what in (1, 2)]


def tips(path: pathlib.Path, points: list[Point]) -> None:
    marks = [{"position": point, "label": str(number)} for number, point in enumerate(points)]
    path.write_text(json.dumps({"markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "controlPoints": marks}]}))


def distances(coapt: str, found: pathlib.Path, truth: pathlib.Path, folder: pathlib.Path) -> list[float]:
    """Mean and 95th percentile from found to truth, and back [mm]."""
    code, _ = command(coapt, "register", str(found), str(truth), "--method", "surface", "-o", str(folder), may_fail=True)
    if code != 0:
        print(f"{found}: not registered onto {truth}; no distances", file=sys.stderr)
        return [math.nan] * 4
    apart = json.loads((folder / "registration.json").read_text())["distances_before"]
    return [apart[way][figure] for way in ("to_target", "from_target") for figure in ("mean_mm", "p95_mm")]


def closure(coapt: str, folder: pathlib.Path, rule: list[str]) -> dict[str, float]:
    """The valve that was found, closed, beside the one that was imaged."""
    opened, closed = folder / "phantom/open", folder / "phantom/closed"
    code, _ = command(coapt, "close", str(opened / "image.nrrd"), "--annulus", str(opened / "annulus.mrk.json"), "--annulus-closed",
                      str(closed / "annulus.mrk.json"), "--papillary", str(folder / "tips.mrk.json"), "--dynamic-range", "50",
                      *rule, "-o", str(folder / "closed"), may_fail=True)
    figures = dict.fromkeys(("closed_to_truth_mean", "closed_to_truth_p95", "closed_from_truth_mean", "closed_from_truth_p95",
                             "orifice_error_mm2"), math.nan)
    if code not in (0, 4):
        return {"closed": 0} | figures
    apart = distances(coapt, folder / "closed/result/closed.obj", closed / "surface.obj", folder / "closed_registered")
    orifices = [json.loads((result / "result.json").read_text())["metrics"].get("orifice_area_mm2", math.nan)
                for result in (folder / "closed/result", folder / "truth")]
    return {"closed": 1} | dict(zip(figures, [*apart, abs(orifices[0] - orifices[1])]))


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


def bad_edges(triangles: list[tuple[int, int, int]]) -> int:
    """Edges that more than two triangles share, or two that face opposite ways."""
    edges = [(t[k], t[(k + 1) % 3]) for t in triangles for k in range(3)]
    return len(edges) - len(set(edges))


def made_phantom(coapt: str, case: Case, seed: int, folder: pathlib.Path) -> None:
    """Of a valve with chords and tissue by the rules that `coapt close` has: where closed valves differ it is due to the image."""
    command(coapt, "generate", "mitral", "--seed", str(seed), "--triangles", "2500", "-o", str(folder / "drawn"))
    valve = json.loads((folder / "drawn/valve.json").read_text())
    for key in ("chords", "junctions", "membranes", "papillary_closed"):
        valve.pop(key, None)
    (folder / "drawn/bare.json").write_text(json.dumps(valve))
    tips(folder / "tips.mrk.json", valve["papillary"])
    command(coapt, "chords", str(folder / "drawn/bare.json"), "--zones", "free_edge", "rough", "-o", str(folder / "valve/valve.json"))
    command(coapt, "import", str(folder / "valve/valve.json"), "-o", str(folder / "scene_of_truth"))
    scene = str(folder / "scene_of_truth/scene.json")
    command(coapt, "solve", scene, "--no-report", "-o", str(folder / "truth"))
    command(coapt, "phantom", scene, "--closed", str(folder / "truth"), "--voxel", case.voxel, "--psf", *case.psf, "--dropout",
            str(case.dropout), "--shadows", str(case.shadows), "--thickness", f"{TRUE_THICKNESS}mm", "--seed", str(seed),
            "-o", str(folder / "phantom"))


def measure(coapt: str, case: Case, seed: int, folder: pathlib.Path, method: str, rule: list[str]) -> dict[str, float]:
    made_phantom(coapt, case, seed, folder)
    truth, found = folder / "phantom/open", folder / "found"
    _, megabytes = command(coapt, "segment", str(truth / "image.nrrd"), "--annulus", str(truth / "annulus.mrk.json"), "--dynamic-range",
                           "50", "--method", method, *rule, "-o", str(found))
    apart = distances(coapt, found / "leaflets.obj", truth / "surface.obj", folder / "registered")
    code, _ = command(coapt, "import", str(found / "valve.json"), "-o", str(folder / "scene"), may_fail=True)
    dice = [math.nan, math.nan]  # where what was found passes through itself, which is refused
    if code == 0:
        command(coapt, "phantom", str(folder / "scene/scene.json"), "--voxel", case.voxel, "--thickness", f"{TRUE_THICKNESS}mm",
                "-o", str(folder / "again"))
        dice = cavity_dice(labels(truth / "labels.nrrd"), labels(folder / "again/open/labels.nrrd"))
    figures = json.loads((found / "segmentation.json").read_text())
    valve = json.loads((found / "valve.json").read_text())
    points, triangles = obj(found / "leaflets.obj")
    surface = obj(truth / "surface.obj")
    edge, ring = markup(truth / "free_edge.mrk.json"), markup(truth / "annulus.mrk.json")
    found_edge = [points[v] for v in valve["free_edge"]]
    area = sum(0.5 * math.hypot(*cross_of(surface[0], t)) for t in surface[1])
    dropout = vtp_array(truth / "surface.vtp", "dropout")[-len(surface[1]):]  # behind those of the chords
    covered, covered_gaps = coverage(found, surface, found_edge, dropout)
    return dict(zip(("to_truth_mean", "to_truth_p95", "from_truth_mean", "from_truth_p95"), apart)) | {
        "area_percent": 100 * abs(figures["area_mm2"] / area - 1),
        "free_edge_mean": both_ways(found_edge, edge),
        "annulus_mean": both_ways([points[v] for v in valve["annulus"]], ring),
        "loops": loops_of(triangles), "bad_edges": bad_edges(triangles), "least_angle_deg": figures["least_angle_deg"],
        "thickness_percent": 100 * abs(figures["thickness_mm"]["median"] / TRUE_THICKNESS - 1),
        "dice_atrium": dice[0], "dice_ventricle": dice[1], "coverage_2_sd": covered, "coverage_2_sd_gaps": covered_gaps,
    } | closure(coapt, folder, rule) | {
        "voxels": math.prod(figures["voxels"]), "cpu_s": figures["cpu_seconds"], "peak_mb": megabytes,
    }


def cross_of(points: list[Point], triangle: tuple[int, int, int]) -> list[float]:
    a, b, c = (points[corner] for corner in triangle)
    u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def cells(key: str, case: Case, rows: list[dict[str, float]]) -> list[str]:
    """Median, worst, and how many meet the goal."""
    values = sorted(row[key] for row in rows if math.isfinite(row[key]))
    if not values:
        return ["", "", ""]
    goal = (case.goals | COMMON).get(key)
    if key == "loops":
        met = [value == goal for value in values]
    else:
        met = [] if goal is None else [value >= goal if key in FLOORS else value <= goal for value in values]
    worst = values[0] if key in FLOORS else values[-1]
    counted = f"{sum(met)} of {len(rows)}" + (f" ({'≥' if key in FLOORS else '=' if key == 'loops' else '≤'} {goal:g})" if met else "")
    number = lambda value: "0" if value < 1e-9 else f"{value:.3g}" if value < 1000 else str(round(value))
    return [number(statistics.median(values)), number(worst), counted if met else ""]


def print_table(names: list[str], rows: dict[str, list[dict[str, float]]]) -> None:
    titles = [f"{CASES[name].voxel.removesuffix('mm')} mm{f', {100 * CASES[name].dropout:.0f} % dropout' * (CASES[name].dropout > 0)}"
              f"{', sector' * (name == 'sector')}" for name in names]
    print("| | " + " | ".join(f"{title}: median | worst | goal met by" for title in titles) + " |")
    print("|---|" + "---|---|---|" * len(names))
    for key, what in NAMES.items():
        print(f"| {what} | " + " | ".join(" | ".join(cells(key, CASES[name], rows[name])) for name in names) + " |")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/ci/bin/coapt")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--case", action="append", choices=CASES)
    parser.add_argument("--method", default="ridge")
    parser.add_argument("--edge")
    parser.add_argument("-o", "--output", type=pathlib.Path)
    options = parser.parse_args()
    names = options.case or list(CASES)
    rule = ["--edge", options.edge] if options.edge else []
    rows: dict[str, list[dict[str, float]]] = {name: [] for name in names}
    for seed in range(options.seeds):
        for name in names:
            with tempfile.TemporaryDirectory() as folder:
                rows[name].append(measure(options.coapt, CASES[name], seed, pathlib.Path(folder), options.method, rule))
            print(name, seed, {key: round(value, 3) for key, value in rows[name][-1].items()}, file=sys.stderr, flush=True)
    print_table(names, rows)
    kept = [{"case": name, "seed": seed} | row for name in names for seed, row in enumerate(rows[name])]
    if options.output:
        with options.output.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, list(kept[0]))
            writer.writeheader()
            writer.writerows(kept)


if __name__ == "__main__":
    main()
