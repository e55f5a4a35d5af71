#!/usr/bin/env python3
"""Time and error of `coapt register` on generated valves, beside plain iterative closest points.

    bench/registration.py COAPT [--seeds N] [--sizes 2000 10000] | bench/tables.py --record registration --machine ... --command ...

For each seed a valve of its own (`coapt generate mitral --seed`), turned by 30 degrees about a random axis and moved by 10 mm, is
brought back: whole onto itself (equal), half of it onto the whole (half), and half of it as a scan, with 0.5 mm of noise in each
coordinate and 20 % of its vertices 8 mm off (noisy). Times are CPU seconds of the command, medians over the seeds. The floor is the
same command by landmarks: reading, distances in both directions, writing. The baseline is point-to-point ICP with SciPy's k-d tree from
the same start, until a step moves less than 1e-6 mm or 200 steps: its time without reading or writing, and how often it ends elsewhere
than the registration: farther than 1 mm (root mean square) from the true place. Errors are root mean squares over the vertices.
"""
import argparse
import json
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np
from scipy.spatial import cKDTree

ANGLE, SHIFT_MM, NOISE_MM, OUTLIERS, OUTLIER_MM, ELSEWHERE_MM = np.radians(30), 10, 0.5, 0.2, 8, 1


def read_obj(path: pathlib.Path) -> tuple[np.ndarray, np.ndarray]:
    lines = path.read_text(encoding="utf-8").splitlines()
    points = [line.split()[1:4] for line in lines if line.startswith("v ")]
    faces = [[corner.split("/")[0] for corner in line.split()[1:4]] for line in lines if line.startswith("f ")]
    return np.array(points, dtype=float), np.array(faces, dtype=int) - 1


def write_obj(path: pathlib.Path, points: np.ndarray, faces: np.ndarray) -> None:
    text = "".join("v %.17g %.17g %.17g\n" % tuple(p) for p in points)
    path.write_text(text + "".join("f %d %d %d\n" % tuple(f + 1) for f in faces), encoding="utf-8")


def write_landmarks(path: pathlib.Path, points: np.ndarray) -> None:
    markups = {"markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "coordinateUnits": "mm",
                            "controlPoints": [{"id": str(k), "position": list(p)} for k, p in enumerate(points)]}]}
    path.write_text(json.dumps(markups), encoding="utf-8")


def motion(random: np.random.Generator, centre: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A rotation about the centre and a shift, as x -> turn x + shift."""
    axis, shift = random.normal(size=3), random.normal(size=3)
    axis /= np.linalg.norm(axis)
    cross = np.cross(np.eye(3), axis).T
    turn = np.eye(3) + np.sin(ANGLE) * cross + (1 - np.cos(ANGLE)) * cross @ cross
    return turn, centre - turn @ centre + SHIFT_MM * shift / np.linalg.norm(shift)


def case_of(name: str, random: np.random.Generator, points: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What is to be moved, in its true place."""
    if name == "equal":
        return points, faces
    angle = random.uniform(0, 2 * np.pi)
    side = np.array([np.cos(angle), np.sin(angle), 0])
    kept = faces[(points[faces].mean(axis=1) - points.mean(axis=0)) @ side > 0]
    used, new = np.unique(kept, return_inverse=True)
    half, faces = points[used], new.reshape(-1, 3)
    if name == "noisy":
        half = half + random.normal(scale=NOISE_MM, size=half.shape)
        off = random.random(len(half)) < OUTLIERS
        way = random.normal(size=(off.sum(), 3))
        half[off] += OUTLIER_MM * way / np.linalg.norm(way, axis=1, keepdims=True)
    return half, faces


def icp(moving: np.ndarray, target: np.ndarray) -> np.ndarray:
    """Point-to-point, with the motion of each step by singular values (Besl & McKay 1992)."""
    tree = cKDTree(target)
    for _ in range(200):
        pairs = target[tree.query(moving)[1]]
        a, b = moving.mean(axis=0), pairs.mean(axis=0)
        u, _, v = np.linalg.svd((moving - a).T @ (pairs - b))
        turn = (v.T * [1, 1, np.sign(np.linalg.det(v.T @ u.T))]) @ u.T
        new = (moving - a) @ turn.T + b
        step = np.abs(new - moving).max()
        moving = new
        if step < 1e-6:
            break
    return moving


def seconds(command: list[str]) -> tuple[float, bool]:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run(command, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, run.returncode == 0


def rms(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.sqrt(((a - b) ** 2).sum(axis=1).mean()))


def measured(coapt: str, name: str, triangles: int, seed: int, folder: pathlib.Path) -> dict[str, float]:
    subprocess.run([coapt, "generate", "mitral", "--preset", "benchmark", "--triangles", str(triangles), "--seed", str(seed), "-o", str(folder)], check=True,
                   capture_output=True)
    points, faces = read_obj(folder / "leaflets.obj")
    random = np.random.default_rng(1000 * triangles + seed)
    truth, part = case_of(name, random, points, faces)
    turn, shift = motion(random, points.mean(axis=0))
    moving = truth @ turn.T + shift
    write_obj(folder / "a.obj", moving, part)
    write_obj(folder / "b.obj", points, faces)
    three = [0, len(truth) // 3, 2 * len(truth) // 3]
    write_landmarks(folder / "a.mrk.json", moving[three])
    write_landmarks(folder / "b.mrk.json", truth[three])
    names = [str(folder / "a.obj"), str(folder / "b.obj"), "-o", str(folder / "out")]
    floor, _ = seconds([coapt, "register", *names, "--landmarks", str(folder / "a.mrk.json"), str(folder / "b.mrk.json")])
    taken, was_found = seconds([coapt, "register", *names])
    error = float("inf")
    if was_found:
        found = np.array(json.loads((folder / "out/registration.json").read_text(encoding="utf-8"))["transform"])
        error = rms(moving @ found[:3, :3].T + found[:3, 3], truth)
    began = time.process_time()
    plain = icp(moving, points)
    return {"taken": taken, "floor": floor, "error": error, "plain": time.process_time() - began, "plain_error": rms(plain, truth)}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("coapt")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--sizes", type=int, nargs="+", default=[2000, 10000])
    given = parser.parse_args()
    columns = ["surfaces", "triangles", "CPU s", "floor s", "ICP s", "error mm, median", "greatest", "elsewhere", "ICP elsewhere"]
    print("| " + " | ".join(columns) + " |\n" + "|---" * len(columns) + "|")
    for name in ("equal", "half", "noisy"):
        for triangles in given.sizes:
            with tempfile.TemporaryDirectory() as folder:
                runs = [measured(given.coapt, name, triangles, seed, pathlib.Path(folder)) for seed in range(1, given.seeds + 1)]
            middle = {key: statistics.median(run[key] for run in runs) for key in runs[0]}
            row = [name, str(triangles), *(f"{middle[key]:.2g}" for key in ("taken", "floor", "plain", "error")),
                   f"{max(run['error'] for run in runs):.2g}",
                   *(f"{sum(run[key] > ELSEWHERE_MM for run in runs)} of {len(runs)}" for key in ("error", "plain_error"))]
            print("| " + " | ".join(row) + " |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
