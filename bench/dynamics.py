#!/usr/bin/env python3
"""Closes Hammer's mass-spring valve in time and at once, and prints a Markdown table.

    bench/dynamics.py [path of coapt] [--runs N] [--largest TRIANGLES] [--model NAME]

The generated valve with the springs, chords and pressure of a published mass-spring model (`coapt generate mitral
--model`), about 625, 2,500 and 10,000 triangles, without contact and with the barrier, to a residual of 1e-6, by
`dynamic` (backward differences with a sparse Cholesky factor, the same with conjugate gradients as in the source, and
semi-implicit Euler) and by `newton`. CPU time of the solve, the better of N runs: what separates conjugate gradients from
the factor is the linear solver, and what separates `dynamic` from `newton` is static against dynamic. The times of the
papers stand beside those of the same model in docs/papers, which bench/papers.py makes.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

from runs import print_header, solved

VALVES = (625, 2500, 10000)  # triangles
METHODS = {
    "newton": {"type": "newton"},
    "dynamic": {"type": "dynamic"},
    "dynamic, conjugate gradients": {"type": "dynamic", "dynamics": {"linear_solver": "conjugate_gradients"}},
    "dynamic, semi-implicit Euler": {"type": "dynamic", "dynamics": {"integration": "semi_implicit_euler"}}}


def scene_of(coapt: str, folder: pathlib.Path, model: str, triangles: int, contact: str) -> dict:
    subprocess.run([coapt, "generate", "mitral", "--preset", "benchmark", "--model", model, "--triangles", str(triangles), "--contact", contact,
                    "-o", str(folder)], check=True, stdout=subprocess.DEVNULL)
    text = (folder / "scene.json").read_text()
    return json.loads("\n".join(line.split("//")[0] for line in text.splitlines()))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--runs", type=int, default=2)
    parser.add_argument("--largest", type=int, default=10000)
    parser.add_argument("--max-seconds", default="120")
    parser.add_argument("--model", default="hammer-2008")
    options = parser.parse_args()
    print_header("triangles", "contact", "method", "status", "residual", "steps", "factorisations", "intersections",
                 "CPU s")
    for triangles in VALVES:
        if triangles > options.largest:
            continue
        for contact in ["none", "barrier"]:
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                scene = scene_of(options.coapt, folder, options.model, triangles, contact)
                for method, keys in METHODS.items():
                    scene["solver"] = keys | {"tolerance": 1e-6}
                    (folder / "scene.json").write_text(json.dumps(scene))
                    runs = [solved(options.coapt, folder / "scene.json", "--max-seconds", options.max_seconds)
                            for _ in range(options.runs)]
                    best = min(runs, key=lambda result: result["time"]["cpu_s"])
                    cpu = best["time"]["cpu_s"]
                    print(f"| {best['mesh']['triangles']} | {contact} | {method} | {best['status']} | "
                          f"{best['residual']:.0e} | {best['iterations']} | {best['evaluations']['factorisations']} | "
                          f"{best['metrics']['intersections']} | {cpu:.2f} |", flush=True)


if __name__ == "__main__":
    main()
