#!/usr/bin/env python3
"""Walczak et al. 2019 on generated valves: the ten cases of the paper's table 2, and its interventions.

    bench/papers_walczak.py [path of coapt] [--table cases|repairs] [--cases A1 B5 ...] [--steps-20 N]

cases: for each row of table 2 a generated valve of about as many facets (the seed is the number of the row), with straight
chords from tips that nobody saw (`coapt chords --unseen-tips`, section 3.5), closed by the model `walczak-2019` with 3 sweeps
until it rests; and N steps with 20 sweeps, for their time. A time is of one core: wall time of sweeps and collision
detection, times the share of it that the process had a core. The generator has no pathological valves: rows B are its
normal ones, drawn with other dimensions.
repairs: the valve of A1 closed, and opened (diastole), without a repair, with a ring, with chords and tips changed, and with
one to three clips (section 3.8), 5 mm wide and 9 mm deep.
Prints a Markdown table; bench/tables.py --record keeps it.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile
from typing import NamedTuple

from runs import print_header, solved


class Case(NamedTuple):
    """A row of table 2: sizes, times of a step [ms], collision detection [ms], steps and area [mm2] at convergence."""

    name: str
    vertices: int
    edges: int
    faces: int
    area: int
    time_3: int
    time_20: int
    collisions: int
    steps: int
    area_3: int


TABLE_2 = [
    Case("A1", 1365, 3934, 2569, 1707, 19, 37, 2, 772, 1706),
    Case("A2", 1643, 4759, 3116, 2076, 20, 42, 3, 1052, 2073),
    Case("A3", 2252, 6547, 4293, 2780, 21, 51, 4, 1636, 2784),
    Case("A4", 1491, 4311, 2820, 1860, 19, 39, 2, 708, 1858),
    Case("A5", 2006, 5813, 3805, 2514, 21, 47, 3, 908, 2515),
    Case("B1", 2699, 7834, 5133, 3312, 22, 57, 4, 1692, 3311),
    Case("B2", 2825, 8188, 5359, 3531, 22, 58, 5, 1400, 3531),
    Case("B3", 2344, 6758, 4408, 2860, 21, 51, 4, 1996, 2860),
    Case("B4", 1830, 5305, 3475, 2312, 20, 42, 3, 800, 2310),
    Case("B5", 3008, 8778, 5770, 3855, 23, 63, 5, 3788, 3855)]

CHORDS = ["--unseen-tips", "--zones", "free_edge", "rough", "--count", "24"]

REPAIRS = {
    "none": [],
    "ring, 30 mm": [{"type": "ring", "size": "30 mm"}],
    "primary chords 10 % shorter": [{"type": "chord_length", "materials": "primary", "factor": 0.9}],
    "primary chords 20 % longer": [{"type": "chord_length", "materials": "primary", "factor": 1.2}],
    "tips 4 mm down": [{"type": "papillary", "by": [0, 0, -4]}],
    "one clip": [{"type": "clip", "at": [0.5]}],
    "two clips": [{"type": "clip", "at": [0.4, 0.6]}],
    "three clips": [{"type": "clip", "at": [0.3, 0.5, 0.7]}]}


def called(coapt: str, *arguments: object) -> None:
    run = subprocess.run([coapt, *map(str, arguments)], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        raise SystemExit(f"coapt {' '.join(map(str, arguments))}:\n{run.stdout}{run.stderr}")


def valve(coapt: str, folder: pathlib.Path, faces: int, seed: int) -> pathlib.Path:
    """A generated valve with chords by the paper's rule, as a scene of the paper's model."""
    called(coapt, "generate", "mitral", "--preset", "benchmark", "--triangles", faces, "--seed", seed, "-o", folder / "shape")
    called(coapt, "chords", folder / "shape/valve.json", *CHORDS, "-o", folder / "chords/valve.json")
    called(coapt, "import", folder / "chords/valve.json", "--model", "walczak-2019", "--no-repair", "-o", folder / "scene")
    return folder / "scene/scene.json"


def changed(scene: pathlib.Path, name: str, xpbd: dict, edits: list[dict] | None = None) -> pathlib.Path:
    """The scene with other options of xpbd and with interventions, beside it."""
    text = "\n".join(line.split("//")[0] for line in scene.read_text().splitlines())
    data = json.loads(text)
    data["solver"]["xpbd"].update(xpbd)
    data["interventions"] = edits or []
    path = scene.parent / f"{name}.json"
    path.write_text(json.dumps(data))
    return path


def step_ms(result: dict) -> float:
    """Of one core, in a step: sweeps and collision detection."""
    time = result["time"]
    spent = time["by_phase"]["sweeps"] + time["by_phase"].get("collisions", 0)
    return 1e3 * spent * min(1, time["cpu_s"] / time["wall_s"]) / max(result["iterations"], 1)


def case_cells(coapt: str, case: Case, seed: int, steps_20: int) -> list[str]:
    with tempfile.TemporaryDirectory() as folder:
        scene = valve(coapt, pathlib.Path(folder), case.faces, seed)
        three = solved(coapt, scene)
        twenty = solved(coapt, changed(scene, "twenty", {"iterations": 20, "steps": steps_20}))
    metrics = three["metrics"]
    steps = f"{three['iterations']}" if "at rest" in three["message"] else f"more than {three['iterations']}"
    return [case.name, f"{case.faces}", f"{three['mesh']['triangles']}", f"{case.time_3}, {case.time_20}",
            f"{step_ms(three):.1f}, {step_ms(twenty):.1f}", f"{case.steps}", steps, f"{case.area_3 - case.area:+d}",
            f"{metrics['leaflet_area_change_mm2']:+.1f}", f"{metrics['orifice_area_mm2']:.1f}", f"{metrics['intersections']}"]


def repair_cells(coapt: str, scene: pathlib.Path, name: str, number: int) -> list[str]:
    cells = [name]
    for phase in ("systole", "diastole"):
        result = solved(coapt, changed(scene, f"{phase}_{number}", {"phase": phase}, REPAIRS[name]))
        if "metrics" not in result:
            raise SystemExit(f"{name}, {phase}: {result['message']}")
        cells += [f"{result['metrics']['orifice_area_mm2']:.1f}", f"{result['metrics']['leaflet_area_change_mm2']:+.1f}"]
    return cells


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--table", choices=["cases", "repairs"], default="cases")
    parser.add_argument("--cases", nargs="*", default=[case.name for case in TABLE_2])
    parser.add_argument("--steps-20", type=int, default=200)
    given = parser.parse_args()
    if given.table == "cases":
        print_header("case", "facets", "ours", "ms a step, 3 and 20 sweeps", "ours", "steps", "ours", "change of area mm2", "ours",
                     "orifice mm2", "crossings")
        for seed, case in enumerate(TABLE_2, 1):
            if case.name in given.cases:
                print("| " + " | ".join(case_cells(given.coapt, case, seed, given.steps_20)) + " |", flush=True)
        return
    print_header("repair", "closed: orifice mm2", "change of area mm2", "opened: orifice mm2", "change of area mm2")
    with tempfile.TemporaryDirectory() as folder:
        scene = valve(given.coapt, pathlib.Path(folder), TABLE_2[0].faces, 1)
        for number, name in enumerate(REPAIRS):
            print("| " + " | ".join(repair_cells(given.coapt, scene, name, number)) + " |", flush=True)


if __name__ == "__main__":
    main()
