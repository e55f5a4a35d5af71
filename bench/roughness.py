#!/usr/bin/env python3
"""Measures how rough valves are, and prints a Markdown table: valve files, then seeds of `coapt generate --rough`.

    bench/roughness.py [path of coapt] [--data FOLDER] [--seeds N] [--triangles N]

Of each valve JSON that FOLDER (the shared data) has, of the tricuspid ones with tips that move (real_valves.py), and of
N seeds each of the mitral and the tricuspid kind (default
20, of 1,700 triangles; the row gives the least, the median and the greatest of the seeds):

    segments       of chords; strands at a tip: of the busiest tip; insertions: chord ends at leaflet vertices
    slack          share of the segments longer by more than 1 % than the straight way in the open valve; the longest
    short          share of the segments shorter by more than 1 %; the shortest
    pulled         greatest strain of a strand once the tips have moved and nothing else has, as a solve may start; and
                   the greatest that a whole chain of strands from tip to leaflet needs even if its branch points move
    aspect         longest edge over height of the triangles: median, at 95 %, greatest; share above 30
    edges          longest over shortest edge, both at 5 % from the ends
    moves          greatest way of annulus and of tips [mm]
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import tempfile

from real_valves import WIDE
from runs import print_header

VALVES = ["mitral-ct-normal1/valve_n32.json", "mitral-ct-normal1/valve_n64.json", "mitral-ct-normal1/valve_n128.json",
          "trivalve11-healthy/valve_coarse.json", "trivalve11-healthy/valve.json"]
COLUMNS = ["triangles", "segments", "strands at a tip", "insertions", "slack %", "longest %", "short %", "shortest %",
           "pulled strand %", "pulled chain %", "aspect median", "95 %", "greatest", "above 30 %", "edges", "annulus mm",
           "tips mm"]


def read_obj(file: pathlib.Path) -> tuple[list, list]:
    points, triangles = [], []
    for line in file.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(w) for w in words[1:4]])
        elif words[:1] == ["f"]:
            triangles.append([int(w.split("/")[0]) - 1 for w in words[1:4]])
    return points, triangles


def at_share(ascending: list, share: float) -> float:
    return ascending[min(len(ascending) - 1, int(share * len(ascending)))]


def greatest_way(there: list, back: list) -> float:
    return max((math.dist(a, b) for a, b in zip(there, back)), default=0)


def chord_numbers(valve: dict, points: list) -> list[float]:
    tips, junctions, chords = valve["papillary"], valve.get("junctions", []), valve["chords"]
    closed_tips = valve.get("papillary_closed") or tips
    places = {"papillary": tips, "junction": junctions, "leaflet": points}

    def name(end: dict) -> tuple:
        return next((kind, end[kind]) for kind in places if kind in end)

    def place(end: tuple) -> list:
        return places[end[0]][end[1]]

    segments = [(name(c["from"]), name(c["to"]), c["rest_length"]) for c in chords]
    ratios = [length / max(math.dist(place(a), place(b)), 1e-9) - 1 for a, b, length in segments]
    at_tip = [sum(a == ("papillary", i) for a, _, _ in segments) for i in range(len(tips))]
    before = {b: (a, length) for a, b, length in segments if b[0] == "junction"}
    moved = {"papillary": closed_tips, "junction": junctions, "leaflet": points}
    alone = [math.dist(moved[a[0]][a[1]], place(b)) / length - 1 for a, b, length in segments]
    pulled = []
    for a, b, length in segments:
        if b[0] != "leaflet":
            continue
        while a in before:
            a, more = before[a]
            length += more
        if a[0] == "papillary":
            pulled.append(math.dist(closed_tips[a[1]], place(b)) / length - 1)
    count = len(segments)
    return [count, max(at_tip), sum(b[0] == "leaflet" for _, b, _ in segments),
            100 * sum(r > 0.01 for r in ratios) / count, 100 * max(ratios),
            100 * sum(r < -0.01 for r in ratios) / count, 100 * min(ratios),
            100 * max(alone), 100 * max(pulled)]


def mesh_numbers(points: list, triangles: list) -> list[float]:
    aspects, lengths = [], []
    for a, b, c in triangles:
        p, q, r = points[a], points[b], points[c]
        u, v = [y - x for x, y in zip(p, q)], [y - x for x, y in zip(p, r)]
        cross = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        sides = [math.dist(p, q), math.dist(q, r), math.dist(r, p)]
        aspects.append(max(sides) ** 2 / max(math.hypot(*cross), 1e-300))
        lengths += sides
    aspects.sort()
    lengths.sort()
    return [statistics.median(aspects), at_share(aspects, 0.95), aspects[-1],
            100 * sum(a > 30 for a in aspects) / len(aspects), at_share(lengths, 0.95) / at_share(lengths, 0.05)]


def numbers(file: pathlib.Path, tips_move: tuple = (0, 0, 0)) -> list[float]:
    valve = json.loads(file.read_text())
    if any(tips_move):
        valve["papillary_closed"] = [[p[c] + tips_move[c] for c in range(3)] for p in valve["papillary"]]
    points, triangles = read_obj(file.parent / valve["leaflets"])
    ring = valve.get("annulus_closed")
    ways = [greatest_way([points[v] for v in valve["annulus"]], ring) if ring else 0,
            greatest_way(valve["papillary"], valve.get("papillary_closed") or valve["papillary"])]
    return [len(triangles), *chord_numbers(valve, points), *mesh_numbers(points, triangles), *ways]


def shown(value: float) -> str:
    return f"{value:.0f}" if abs(value) >= 20 or value == int(value) else f"{value:.1f}"


def print_row(name: str, cells: list[str]) -> None:
    print("| " + " | ".join([name, *cells]) + " |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--data", type=pathlib.Path, default="../shared/data")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--triangles", type=int, default=1700)
    arguments = parser.parse_args()
    print_header("valve", *COLUMNS)
    for valve in VALVES:
        if (arguments.data / valve).exists():
            name = valve.removesuffix(".json").replace("/valve_", " ").replace("/valve", " full")
            print_row(name, [shown(value) for value in numbers(arguments.data / valve)])
            for _, move in WIDE if "trivalve" in valve else []:
                print_row(f"the same, tips move by {move}", [shown(v) for v in numbers(arguments.data / valve, move)])
        else:
            print(f"skipped: {valve} is not in {arguments.data}")
    with tempfile.TemporaryDirectory() as folder:
        for kind in ("mitral", "tricuspid"):
            rows = []
            for seed in range(1, arguments.seeds + 1):
                subprocess.run([arguments.coapt, "generate", kind, "--rough", str(seed), "--triangles",
                                str(arguments.triangles), "-o", folder], stdout=subprocess.DEVNULL, check=True)
                rows.append(numbers(pathlib.Path(folder) / "valve.json"))
            columns = [sorted(column) for column in zip(*rows)]
            print_row(f"rough {kind}", [f"{shown(c[0])}, {shown(statistics.median(c))}, {shown(c[-1])}" for c in columns])


if __name__ == "__main__":
    main()
