#!/usr/bin/env python3
"""Times whole closures of the generated mitral valve (StVK, first-order solvers) with the command itself and prints a Markdown table.

    bench/closure.py [path of coapt] [--runs N]

CPU time of the solve (best of N runs), iterations, gradients and peak memory for each size, solver and load;
`ceres` is the named peer of `lbfgs` in the same run. The last column is the CPU time over that of `lbfgs`.
"""
import pathlib
import subprocess
import tempfile

from runs import parsed_arguments, print_header, solved

CASES = [  # triangles, contact, pressure, solvers
    (625, "none", "follower", ["lbfgs", "ceres", "nlopt", "bfgs"]),
    (625, "none", "frozen", ["lbfgs", "ceres", "nlopt", "bfgs"]),
    (625, "facet", "follower", ["lbfgs"]),
    (2500, "none", "follower", ["lbfgs", "ceres"]),
    (2500, "facet", "follower", ["lbfgs"]),
    (10000, "none", "follower", ["lbfgs", "ceres"]),
    (10000, "none", "frozen", ["lbfgs", "ceres"]),
    (10000, "facet", "follower", ["lbfgs"]),
    (40000, "none", "frozen", ["lbfgs"]),
    (160000, "none", "frozen", ["lbfgs"]),
]


def closed(coapt: str, scene: pathlib.Path, solver: str, limit: float) -> dict:
    return solved(coapt, scene, "--solver", solver, "--tolerance", "1e-6", "--max-seconds", str(limit))


def main() -> None:
    options = parsed_arguments(__doc__, max_seconds=60)
    print_header("triangles", "contact", "pressure", "solver", "status", "residual", "iterations", "gradients", "CPU s",
                 "memory MB", "kB/triangle", "CPU / lbfgs")
    for triangles, contact, pressure, solvers in CASES:
        if triangles > options.largest:
            continue
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([options.coapt, "generate", "mitral", "--preset", "benchmark", "--triangles", str(triangles), "--contact",
                            contact, "--pressure", pressure, "--membrane", "stvk", "-o", folder], check=True, stdout=subprocess.DEVNULL)
            baseline = None
            for solver in solvers:
                runs = options.runs if triangles <= 10000 and contact == "none" else 1
                results = [closed(options.coapt, pathlib.Path(folder) / "scene.json", solver,
                                  options.max_seconds) for _ in range(runs)]
                best = min(results, key=lambda r: r["time"]["cpu_s"])
                cpu, memory = best["time"]["cpu_s"], best["peak_memory_mb"]
                baseline = baseline or cpu
                print(f"| {best['mesh']['triangles']} | {contact} | {pressure} | {solver} | {best['status']} | "
                      f"{best['residual']:.1e} | {best['iterations']} | {best['evaluations']['gradient']} | "
                      f"{cpu:.3f} | {memory:.0f} | {1024 * memory / best['mesh']['triangles']:.2f} | "
                      f"{cpu / baseline:.1f} |", flush=True)


if __name__ == "__main__":
    main()
