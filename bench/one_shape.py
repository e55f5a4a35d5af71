#!/usr/bin/env python3
"""Whether the shape that a valve closes in depends on anything but the valve, as a Markdown table.

    bench/one_shape.py [path of coapt] [--data FOLDER] [--seeds N] [--triangles N] [--direct] [--solvers NAME ...]

Solves each valve of FOLDER (the shared data, up to 2,000 vertices), the generated mitral valve and N rough ones of each
kind (default 6, of 900 triangles) as `coapt import` and `coapt generate` write them; then with its vertices, faces,
corners and chords in two other orders, rotated about a skew axis, with the trust region, and by `dynamic` (or the
solvers named). A cell is the greatest distance [mm] of a leaflet vertex from its place in the first solve, and the
iterations; an exclamation mark: not converged. --direct: without the damped path. The last line counts the cells
below 1e-5 mm, beyond which the two are different equilibria.
"""
import argparse
import json
import math
import pathlib
import random
import subprocess
import tempfile

import numpy

from runs import print_header

VALVES = ["bhv-trileaflet/valve_coarse.json", "mitral-ct-normal1/valve_n32.json", "trivalve11-healthy/valve_coarse.json"]
VERTEX_LISTS = ("annulus", "free_edge", "commissures")
POINT_LISTS = ("annulus_closed", "papillary", "papillary_closed", "junctions")
SAME = 1e-5  # mm


def read_leaflets(file: pathlib.Path) -> tuple[numpy.ndarray, list[tuple[str, list[int]]]]:
    """Vertices, and faces with the line of their group."""
    vertices, faces, group = [], [], ""
    for line in file.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(word) for word in words[1:4]])
        elif words[:1] == ["g"]:
            group = line
        elif words[:1] == ["f"]:
            faces.append((group, [int(word.split("/")[0]) - 1 for word in words[1:4]]))
    return numpy.array(vertices), faces


class Form:
    """A valve in memory: leaflets, valve.json and the text of its scene."""

    def __init__(self, folder: pathlib.Path):
        self.vertices, self.faces = read_leaflets(folder / "leaflets.obj")
        self.valve = json.loads((folder / "valve.json").read_text())
        self.scene = (folder / "scene.json").read_text()
        self.valve.pop("closed_reference", None)
        at = self.scene.find('"reference"')
        if at > 0:
            self.scene = self.scene[:self.scene.rfind(",", 0, at)] + "\n}\n"

    def write(self, folder: pathlib.Path) -> None:
        folder.mkdir(parents=True)
        lines, last = ["v %.17g %.17g %.17g" % tuple(vertex) for vertex in self.vertices], ""
        for group, face in sorted(self.faces, key=lambda item: item[0]):
            if group != last:
                lines.append(group)
            last = group
            lines.append("f %d %d %d" % tuple(v + 1 for v in face))
        (folder / "leaflets.obj").write_text("\n".join(lines) + "\n")
        (folder / "valve.json").write_text(json.dumps(self.valve))
        (folder / "scene.json").write_text(self.scene)

    def shuffle(self, seed: int) -> list[int]:
        """Returns the new number of each vertex."""
        source = random.Random(seed)
        number = list(range(len(self.vertices)))
        source.shuffle(number)
        vertices = numpy.empty_like(self.vertices)
        vertices[number] = self.vertices
        self.vertices = vertices
        source.shuffle(self.faces)
        self.faces = [(group, [number[v] for v in face[k:] + face[:k]])
                      for group, face in self.faces for k in [source.randrange(3)]]
        for key in VERTEX_LISTS:
            if key in self.valve:
                self.valve[key] = [number[v] for v in self.valve[key]]
        for chord in self.valve.get("chords", []):
            for end in ("from", "to"):
                if "leaflet" in chord[end]:
                    chord[end]["leaflet"] = number[chord[end]["leaflet"]]
        source.shuffle(self.valve.get("chords", []))
        return number

    def move(self, rotation: numpy.ndarray, centre: numpy.ndarray) -> None:
        self.vertices = (self.vertices - centre) @ rotation.T + centre
        for key in POINT_LISTS:
            if key in self.valve:
                self.valve[key] = ((numpy.array(self.valve[key]) - centre) @ rotation.T + centre).tolist()


def skew_rotation() -> numpy.ndarray:
    axis, angle = numpy.array([1, 2, 3]) / math.sqrt(14), math.pi / 6
    cross = numpy.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return numpy.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross


def solved(coapt: str, folder: pathlib.Path, *options: str) -> tuple[dict, numpy.ndarray]:
    out = folder / "out"
    subprocess.run([coapt, "solve", str(folder / "scene.json"), "-o", str(out), "--max-seconds", "300", *options],
                   capture_output=True, check=False)
    shape, _ = read_leaflets(out / "closed.obj")
    return json.loads((out / "result.json").read_text()), shape


def row(coapt: str, folder: pathlib.Path, work: pathlib.Path, solvers: list[str], is_direct: bool) -> tuple[list, int, int]:
    path = ["--damped-steps", "0"] if is_direct else []

    def solve(place: pathlib.Path, *options: str) -> tuple[dict, numpy.ndarray]:
        return solved(coapt, place, *path, *options)

    given = Form(folder)
    given.write(work / "given")
    first, shape = solve(work / "given")
    count = len(given.vertices)
    cells = [first["status"], str(first["iterations"]), f"{first['time']['cpu_s']:.2f}", first["certificate"]["stability"]]
    seen = [0, 0]

    def compare(result: dict, other: numpy.ndarray) -> None:
        distance = float(numpy.linalg.norm(other[:count] - shape[:count], axis=1).max())
        seen[0] += distance < SAME and result["converged"]
        seen[1] += 1
        cells.append(f"{distance:.0e}{'' if result['converged'] else '!'} ({result['iterations']})")

    for seed in (1, 2):
        other = Form(folder)
        number = other.shuffle(seed)
        other.write(work / f"order{seed}")
        result, moved = solve(work / f"order{seed}")
        compare(result, moved[number])
    rotation, centre = skew_rotation(), numpy.array([5.0, -3.0, 7.0])
    other = Form(folder)
    other.move(rotation, centre)
    other.write(work / "rotated")
    result, moved = solve(work / "rotated")
    compare(result, (moved - centre) @ rotation + centre)
    other = Form(folder)
    other.scene = other.scene.replace('"type": "newton"', '"type": "newton", "globalisation": "trust_region"')
    other.write(work / "trust_region")
    compare(*solve(work / "trust_region"))
    for solver in solvers:
        compare(*solve(work / "given", "--solver", solver))
    return cells, *seen


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--data", type=pathlib.Path, default="../shared/data")
    parser.add_argument("--seeds", type=int, default=6)
    parser.add_argument("--triangles", type=int, default=900)
    parser.add_argument("--direct", action="store_true")
    parser.add_argument("--solvers", nargs="*", default=["dynamic"])
    arguments = parser.parse_args()
    print_header("valve", "status", "iterations", "CPU s", "stability", "order 1", "order 2", "rotated", "trust region",
                 *arguments.solvers)
    same = total = 0

    def show(name: str, folder: pathlib.Path, work: pathlib.Path) -> None:
        nonlocal same, total
        cells, good, all_ = row(arguments.coapt, folder, work, arguments.solvers, arguments.direct)
        same, total = same + good, total + all_
        print("| " + " | ".join([name, *cells]) + " |", flush=True)

    with tempfile.TemporaryDirectory() as temporary:
        root = pathlib.Path(temporary)
        made = []
        for valve in VALVES:
            if not (arguments.data / valve).exists():
                print(f"skipped: {valve} is not in {arguments.data}")
                continue
            name = valve.removesuffix(".json").replace("/valve_", " ")
            made.append((name, ["import", str(arguments.data / valve)]))
        made.append(("generated mitral", ["generate", "mitral", "--preset", "benchmark"]))
        for kind in ("mitral", "tricuspid"):
            for seed in range(1, arguments.seeds + 1):
                made.append((f"rough {kind} {seed}",
                             ["generate", kind, "--rough", str(seed), "--triangles", str(arguments.triangles)]))
        for k, (name, command) in enumerate(made):
            folder = root / f"valve{k}"
            subprocess.run([arguments.coapt, *command, "-o", str(folder)], capture_output=True, check=True)
            show(name, folder, root / f"work{k}")
    print(f"\n{same} of {total} are the first shape.")


if __name__ == "__main__":
    main()
