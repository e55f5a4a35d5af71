#!/usr/bin/env python3
"""Times kernels in C++ that coapt.energy wrote beside those of the library and prints a Markdown table.

    PYTHONPATH=build/release/python /usr/bin/python3 bench/kernels.py [--runs N]

The cord of Burlina et al. and the neo-Hookean triangle, 2,000 elements in the cache, nanoseconds of an evaluation of one
element; best of N runs of the compiled program, each the best of 300 passes. And the same energies by NumPy, 20,000 elements.
"""
import pathlib
import subprocess
import tempfile
import time

import numpy as np

import coapt
from runs import parsed_arguments, print_header

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Beside the module in a build tree, else where they are installed.
BUILT = [pathlib.Path(coapt._core.__file__).resolve().parents[2] / f"src/{room}/libcoapt_{room}.a" for room in ("energy", "mesh", "core")]
LIBRARIES = BUILT if BUILT[0].exists() else ["-lcoapt_energy", "-lcoapt_mesh", "-lcoapt_core"]
CORD = "t * max((norm(x1 - x0) - r) / rho, 0)**3"
RUBBER = """G = gram(X1 - X0, X2 - X0)
            g = gram(x1 - x0, x2 - x0)
            h * sqrt(det(G)) / 2 * mu / 2 * (trace(inverse(G) * g) + det(G) / det(g) - 3)"""
PAIRS = {"cubic tether": ("TetherCubic", "Cord"), "neo-Hookean triangle": ("CstNeoHookean", "Rubber")}
EVALUATIONS = ["value", "and gradient", "and Hessian", "and projected Hessian"]


def energies(elements: int) -> dict[str, coapt.Energy]:
    """By NumPy; each element has nodes of its own."""
    X = np.tile([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], (elements, 1))
    nodes = np.arange(3 * elements).reshape(-1, 3)
    return {"cubic tether": coapt.energy(CORD, nodes[:, :2], t=0.3, r=1.2, rho=0.7),
            "neo-Hookean triangle": coapt.energy(RUBBER, nodes, X=X, mu=0.33, h=0.8)}


def in_cpp(runs: int) -> dict[str, np.ndarray]:
    """Nanoseconds of EVALUATIONS by the name of the kernel."""
    small = energies(1)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for file, (term, (_, kernel)) in zip(("cord.hpp", "rubber.hpp"), PAIRS.items()):
            (folder / file).write_text(small[term].kernel(kernel))
        subprocess.run(["g++", "-std=c++20", "-O3", "-DNDEBUG", f"-I{folder}", f"-I{ROOT / 'src'}", "-isystem",
                        "/usr/include/eigen3", ROOT / "bench/generated_kernels.cpp",
                        *LIBRARIES, "-o", folder / "program"], check=True)
        lines = [(line.split(":")[0], line.split(":")[1].split()) for _ in range(runs) for line in subprocess.run(
            [folder / "program", "time"], check=True, capture_output=True, text=True).stdout.splitlines()]
    return {kernel: np.min([np.array(numbers, float) for name, numbers in lines if name == kernel], axis=0)
            for kernel in dict(lines)}


def in_numpy(runs: int) -> dict[str, np.ndarray]:
    """The same by the name of the term."""
    found = {}
    for name, term in energies(20_000).items():
        x = np.array(np.tile([[0.0, 0, 0], [1.4, 0.1, 0], [0, 1.2, 0.1]], (20_000, 1)))
        best = np.full(3, np.inf)
        for _ in range(3 * runs):
            for k, function in enumerate((term.value, term.gradient, term.hessian)):
                start = time.perf_counter()
                function(x)
                best[k] = min(best[k], (time.perf_counter() - start) * 1e9 / 20_000)
        found[name] = best
    return found


def main() -> None:
    options = parsed_arguments(__doc__)
    cpp, numpy = in_cpp(options.runs), in_numpy(options.runs)
    print_header("energy", "evaluation", "by hand [ns]", "generated [ns]", "generated / by hand", "NumPy [ns]")
    for term, (ours, generated) in PAIRS.items():
        for k, what in enumerate(EVALUATIONS):
            by_numpy = f"{numpy[term][k]:.0f}" if k < 3 else "-"
            print(f"| {term} | {what} | {cpp[ours][k]:.1f} | {cpp[generated][k]:.1f} | "
                  f"{cpp[generated][k] / cpp[ours][k]:.2f} | {by_numpy} |", flush=True)
    ours, generated = cpp["CstNeoHookean mixed"][3], cpp["Rubber mixed"][3]
    print(f"| neo-Hookean triangle, of all kinds | {EVALUATIONS[3]} | {ours:.1f} | {generated:.1f} | {generated / ours:.2f} | - |")


if __name__ == "__main__":
    main()
