#!/usr/bin/env python3
"""Error against run time of every method with `coapt bench`, on generated and human valves, as Markdown tables.

    bench/error_time.py [path of coapt] [--data FOLDER] [--keep FOLDER] [--cases NAME ...]

FOLDER of --data holds trivalve11-healthy; without it the human valve is left out. --keep: where scenes, bench.json
and bench.html of each case stay. How long it takes follows from the limits of time of the cases; a method that a scene
refuses is named with the reason. Each cell of a table: CPU seconds of one solve to that tolerance, median of the repeats,
and in brackets the greatest algebraic error in mm; "stopped" where the tolerance was not reached in the time of the case.
Costs in factorisations are CPU time over that of one Hessian with its factorisation on the same mesh in the same run.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

from runs import print_header

METHODS = "newton,lbfgs,bfgs,ceres,nlopt,dynamic,xpbd,mass-spring"
CASES = {
    "generated valve, 630 triangles, no contact": (
        ["generate", "mitral", "--preset", "benchmark", "--triangles", "625", "--contact", "none"],
        ["--methods", METHODS, "--repeats", "1", "--max-seconds", "40"]),
    "generated valve, 630 triangles, contact": (
        ["generate", "mitral", "--preset", "benchmark", "--triangles", "625"],
        ["--methods", METHODS, "--repeats", "1", "--max-seconds", "60", "--truth-seconds", "600"]),
    "human tricuspid valve, coarse": (
        ["import", "valve_coarse.json"],
        ["--methods", METHODS, "--tolerances", "1e-2,1e-4,1e-6", "--levels", "0", "--repeats", "1",
         "--max-seconds", "120", "--truth-seconds", "1200"])}


def scene_of(coapt: str, command: list[str], data: pathlib.Path, folder: pathlib.Path) -> pathlib.Path:
    if command[0] == "import":
        command = [command[0], str(data / "trivalve11-healthy" / command[1]), *command[2:]]
    subprocess.run([coapt, *command, "-o", str(folder)], check=True, stdout=subprocess.DEVNULL)
    return folder / "scene.json"


def figure(value: float | None, digits: int = 2) -> str:
    return "" if value is None else f"{value:.{digits}g}"


def cell(run: dict | None) -> str:
    if run is None:
        return ""
    algebraic = run["errors"]["algebraic"]
    error = f" ({algebraic['max_mm']:.0e})" if algebraic else ""
    stop = "" if run["converged"] else "stopped at "
    return f"{stop}{run['cpu_s']['median']:.3g}{error}"


def print_runs(found: dict) -> None:
    tolerances = found["tolerances"]
    print_header("method", "triangles", *(f"{tolerance:.0e}" for tolerance in tolerances),
                 "the last in factorisations", "MB", "to newton's mm")
    for end in found["ends"]:
        runs = {run["tolerance"]: run for run in found["runs"]
                if (run["method"], run["mesh"]) == (end["method"], end["mesh"])}
        if not runs:
            print(f"| {end['method']} | {end['triangles']} | refused: {end['failure']} |" + " |" * (len(tolerances) + 2))
            continue
        last = runs[min(runs)]
        print(f"| {end['method']} | {end['triangles']} | " + " | ".join(cell(runs.get(t)) for t in tolerances) +
              f" | {figure(last['cpu_in_factorisations'], 3)} | {figure(last['peak_memory_mb'], 3)} | "
              f"{figure(last['errors']['method_mm'])} |", flush=True)


def print_meshes(found: dict) -> None:
    print()
    print_header("triangles", "Hessian and factorisation CPU ms", "95 % to the next mesh mm", "observed order",
                 "error of the mesh mm")
    for mesh in found["meshes"]:
        unit, to_next = mesh["factorisation_s"], mesh["distance_to_next"]
        print(f"| {mesh['triangles']} | {figure(unit and 1000 * unit, 3)} | "
              f"{figure(to_next and to_next['p95_mm'], 3)} | {figure(mesh['order'], 3)} | "
              f"{figure(mesh['discretisation_mm'], 3)} |")
    print()
    for mesh in found["meshes"]:
        if mesh["no_equilibrium"]:
            print(f"- no equilibrium on {mesh['triangles']} triangles: {mesh['no_equilibrium']}")
    for grown in found["growth"]:
        print(f"- {grown['method']}: CPU time grows with triangles^{grown['exponent']:.2f} (tolerance {grown['tolerance']:.0e})")
    for line in found["recommendations"]:
        print(f"- {line}")
    models = {run["method"]: run["errors"]["model"] for run in found["runs"] if run["errors"]["model"]}
    for method, model in models.items():
        print(f"- {method}: {model['mean_mm']:.3f} mm to the given closed surface (mean of both directions)")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--data", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path)
    parser.add_argument("--cases", nargs="+", choices=list(CASES), default=list(CASES))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        for case in options.cases:
            command, arguments = CASES[case]
            if command[0] == "import" and not options.data:
                print(f"\n### {case}\n\nleft out: no --data", flush=True)
                continue
            folder = (options.keep or pathlib.Path(name)) / case.replace(",", "").replace(" ", "-")
            scene = scene_of(options.coapt, command, options.data, folder)
            subprocess.run([options.coapt, "bench", str(scene), *arguments, "-o", str(folder / "bench")],
                           stdout=subprocess.DEVNULL, check=False)
            found = json.loads((folder / "bench" / "bench.json").read_text())
            print(f"\n### {case}\n", flush=True)
            print_runs(found)
            print_meshes(found)


if __name__ == "__main__":
    main()
