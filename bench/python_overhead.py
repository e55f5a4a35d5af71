#!/usr/bin/env python3
"""Times the generated mitral valve with the command and with the Python module and prints a Markdown table.

    PYTHONPATH=build/release/python /usr/bin/python3 bench/python_overhead.py [path of coapt] [--runs N]

For each size, best of N runs, in turn: the solver's CPU time in the command, in `coapt.solve`, and there with a callback
at every iterate that looks at the positions; then the wall time that `coapt.solve` spends outside of the library (arguments,
JSON, arrays), and what part of the solver's CPU time that is.
"""
import pathlib
import subprocess
import tempfile
import time

import coapt
from runs import parsed_arguments, print_header, solved


def timed(scene: pathlib.Path, callback=None) -> dict[str, float]:
    start = time.perf_counter()
    result = coapt.solve(scene, callback=callback)
    whole = time.perf_counter() - start
    return {"solver": result.document["time"]["cpu_s"], "outside": whole - result.library_seconds}


def best(runs: list[dict[str, float]], key: str) -> float:
    return min(run[key] for run in runs)


def main() -> None:
    options = parsed_arguments(__doc__)
    print_header("triangles", "command [CPU s]", "Python [CPU s]", "with callback [CPU s]", "outside [ms]",
                 "outside / solver")
    for triangles in (625, 2500):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([options.coapt, "generate", "mitral", "--preset", "benchmark", "--triangles", str(triangles), "-o", folder], check=True,
                           stdout=subprocess.DEVNULL)
            scene = pathlib.Path(folder) / "scene.json"
            command, plain, seen = [], [], []
            for _ in range(options.runs):
                command.append(solved(options.coapt, scene, "--no-report")["time"]["cpu_s"])
                plain.append(timed(scene))
                seen.append(timed(scene, callback=lambda at: bool(at.x.shape)))
            outside, solver = best(plain, "outside"), best(plain, "solver")
            print(f"| {triangles} | {min(command):.3f} | {solver:.3f} | {best(seen, 'solver'):.3f} | {1000 * outside:.2f} | "
                  f"{100 * outside / solver:.2f} % |", flush=True)


if __name__ == "__main__":
    main()
