#!/usr/bin/env python3
"""How far the results of two programs lie apart that other compilers, or other levels of optimisation, made.

    bench/compilers.py FIRST SECOND [SCENE...]    two programs `coapt`; scenes: by default generated shapes and valves

Both solve every scene. A table in Markdown: of the energy and of the metrics with a unit the largest relative difference (over the
greater of the two; a metric below a millionth of its unit is left out), the greatest distance of a vertex between the shapes over
the diagonal of the box around them, and iterations and status of both. `docs/reliability.md` holds what was measured.
"""
import argparse
import json
import math
import pathlib
import subprocess
import sys
import tempfile

SHAPES = {
    "disc, 2,000": ["disc", "--triangles", "2000"],
    "airbag, 2,000": ["airbag", "--triangles", "2000"],
    "tent, 2,000": ["tent", "--triangles", "2000"],
    "mitral valve, 630": ["mitral", "--triangles", "630"],
    "mitral valve, 2,520": ["mitral", "--triangles", "2520"],
    "mitral valve of the benchmark, 2,520": ["mitral", "--triangles", "2520", "--preset", "benchmark"],
}
SMALLEST = 1e-6  # of a metric, in its unit


def solved(program: str, scene: pathlib.Path, folder: pathlib.Path) -> tuple[dict, list[tuple[float, ...]]]:
    """What result.json says, and the vertices of the shape."""
    subprocess.run([program, "solve", str(scene), "-o", str(folder), "--no-report", "--quiet"], check=False)
    lines = (folder / "closed.obj").read_text(encoding="utf-8").splitlines()
    vertices = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
    return json.loads((folder / "result.json").read_text(encoding="utf-8")), vertices


def relative(first: float, second: float) -> float:
    greater = max(abs(first), abs(second))
    return abs(first - second) / greater if greater > 0 else 0


def figures_apart(first: dict, second: dict) -> tuple[float, str]:
    """The largest relative difference of a metric with a unit, and its name."""
    units = ("_mm", "_mm2", "_mm3", "_kpa", "_n", "_strain")
    pairs = [(name, value, second["metrics"].get(name)) for name, value in first["metrics"].items() if name.endswith(units)]
    known = [(relative(a, b), name) for name, a, b in pairs
             if a is not None and b is not None and max(abs(a), abs(b)) > SMALLEST]
    return max(known, default=(0, ""))


def row(name: str, scene: pathlib.Path, programs: list[str], scratch: pathlib.Path) -> str:
    (first, x), (second, y) = (solved(program, scene, scratch / str(k)) for k, program in enumerate(programs))
    box = math.dist([min(axis) for axis in zip(*x)], [max(axis) for axis in zip(*x)])
    shape = max(map(math.dist, x, y)) / box
    energy = relative(first["energy_mj"], second["energy_mj"])
    figure, which = figures_apart(first, second)
    runs = "; ".join(f"{result['status']}, {result['iterations']}" for result in (first, second))
    return f"| {name} | {energy:.1e} | {shape:.1e} | {figure:.1e} (`{which}`) | {runs} |"


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("programs", nargs=2, metavar="PROGRAM")
    arguments.add_argument("scenes", nargs="*", type=pathlib.Path, metavar="SCENE")
    given = arguments.parse_intermixed_args()
    missing = [str(path) for path in (*given.programs, *given.scenes) if not pathlib.Path(path).is_file()]
    if missing:
        print("\n".join(f"{path}: no such file" for path in missing), file=sys.stderr)
        return 2
    programs = [str(pathlib.Path(program).resolve()) for program in given.programs]
    print("| scene | energy | shape, of its size | metric | status and iterations |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        for name, words in ({} if given.scenes else SHAPES).items():
            subprocess.run([programs[0], "generate", *words, "-o", str(scratch / "scene"), "--quiet"], check=True)
            print(row(name, scratch / "scene/scene.json", programs, scratch), flush=True)
        for scene in given.scenes:
            print(row(scene.name, scene.resolve(), programs, scratch), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
