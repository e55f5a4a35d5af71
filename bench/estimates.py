#!/usr/bin/env python3
"""Compares the error that `coapt solve --accuracy` estimates with a later truth and prints a Markdown table.

    bench/estimates.py [path of coapt] [--further N] [--only SHAPE ...]

For each shape, generated or of estimate_scenes.py: the estimate for 95 % of the surface on the mesh that was chosen, and the distance of
the equilibrium on a mesh N cuts (default 2) beyond the finest that the estimate saw to it, from points all over
the finer one. "not reached" is an answer, too. The truth has some 3 % of its own error at N = 2.
"""
import argparse
import json
import math
import pathlib
import random
import subprocess
import tempfile

from estimate_scenes import SCENES

SHAPES = [  # shape, triangles (0: as it comes), accuracy
    ("disc", 96, "0.02mm"),
    ("square", 64, "1mm"),
    ("strip", 64, "1mm"),
    ("sphere", 80, "1mm"),
    ("tent", 64, "10mm"),
    ("airbag", 64, "1mm"),
    ("cylinder", 0, "0.1mm"),
    ("pane", 0, "0.5mm"),
    ("catenoid", 0, "0.05mm"),
    ("sail", 0, "5mm"),
    ("ring", 0, "0.1mm"),
    ("bent", 0, "0.1mm"),
    ("dome", 0, "0.1mm"),
    ("cone", 0, "1mm"),
    ("saddle", 0, "1mm"),
]
SAMPLES = 1000


def difference(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def segment_distance(p, a, b):
    d = difference(b, a)
    t = min(1.0, max(0.0, dot(difference(p, a), d) / dot(d, d)))
    return math.dist(p, [x + t * y for x, y in zip(a, d)])


def facet_distance(p, a, b, c):
    u, v, w = difference(b, a), difference(c, a), difference(p, a)
    uu, uv, vv, wu, wv = dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v)
    determinant = uu * vv - uv * uv
    s, t = (vv * wu - uv * wv) / determinant, (uu * wv - uv * wu) / determinant
    if s >= 0 and t >= 0 and s + t <= 1:
        return math.dist(p, [x + s * y + t * z for x, y, z in zip(a, u, v)])
    return min(segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a))


def read_obj(path):
    lines = [line.split() for line in path.read_text().splitlines()]
    vertices = [[float(x) for x in line[1:4]] for line in lines if line and line[0] == "v"]
    facets = [[int(x.split("/")[0]) - 1 for x in line[1:4]] for line in lines if line and line[0] == "f"]
    return vertices, facets


def p95(finer, coarser):
    """Distance below which 95 % of points of one surface, even by area up to its mesh, are from another."""
    (points, facets), (vertices, targets) = finer, coarser
    draw = random.Random(1)
    chosen = [facets[draw.randrange(len(facets))] for _ in range(SAMPLES)]
    corners = [[vertices[k] for k in facet] for facet in targets]
    found = []
    for facet in chosen:
        p = [sum(points[k][c] for k in facet) / 3 for c in range(3)]
        near = sorted(corners, key=lambda f: min(math.dist(p, q) for q in f))[:12]
        found.append(min(facet_distance(p, *f) for f in near))
    return sorted(found)[int(0.95 * SAMPLES)]


def row(coapt, shape, triangles, accuracy, further, folder):
    scene, result = folder / "scene.json", folder / "result"
    if shape in SCENES:
        mesh, text = SCENES[shape]()
        (folder / "mesh.obj").write_text(mesh)
        scene.write_text(text)
    else:
        subprocess.run([coapt, "generate", shape, "--triangles", str(triangles), "-o", folder], check=True,
                       capture_output=True)
    subprocess.run([coapt, "solve", scene, "-o", result, "--accuracy", accuracy, "--no-report",
                    "--max-seconds", "60"], capture_output=True)
    report = json.loads((result / "result.json").read_text())
    known = report["accuracy"]
    meshes = sorted({solve["triangles"] for solve in known["solves"]})
    estimate = known["discretisation_mm"]
    if estimate is None or not known["reached"]:
        return f"| {shape} | {meshes[0]:,} to {meshes[-1]:,} | not reached | | |"
    levels = len(meshes) - 1 + further
    subprocess.run([coapt, "mesh-study", scene, "--levels", str(levels), "--tolerance", "1e-9", "-o",
                    folder / "study"], capture_output=True)
    if not json.loads((folder / "study" / "mesh_study.json").read_text())["converged"]:
        return f"| {shape} | {meshes[0]:,} to {meshes[-1]:,} | {estimate:.3g} | not converged | |"
    chosen, finest = meshes[0] * 4 ** known["cuts"], meshes[0] * 4 ** levels
    truth = p95(*(read_obj(folder / "study" / f"closed_{count}.obj") for count in (finest, chosen)))
    return f"| {shape} | {chosen:,} of up to {meshes[-1]:,} | {estimate:.3g} | {truth:.3g} | {estimate / truth:.2f} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--further", type=int, default=2)
    parser.add_argument("--only", nargs="+", default=[shape for shape, _, _ in SHAPES])
    arguments = parser.parse_args()
    print("| shape | triangles | estimate [mm] | later [mm] | ratio |\n|---|---|---|---|---|")
    for shape, triangles, accuracy in SHAPES:
        if shape not in arguments.only:
            continue
        with tempfile.TemporaryDirectory() as folder:
            print(row(arguments.coapt, shape, triangles, accuracy, arguments.further, pathlib.Path(folder)), flush=True)


if __name__ == "__main__":
    main()
