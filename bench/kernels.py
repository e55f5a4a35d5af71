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
# Knows the alignment that the headers ask for: beside the module in a build tree, else where it is installed.
CORE = pathlib.Path(coapt._core.__file__).resolve().parents[2] / "src/core/libcoapt_core.a"
CORD = "t * max((norm(x1 - x0) - r) / rho, 0)**3"
RUBBER = """G = gram(X1 - X0, X2 - X0)
            g = gram(x1 - x0, x2 - x0)
            h * sqrt(det(G)) / 2 * mu / 2 * (trace(inverse(G) * g) + det(G) / det(g) - 3)"""
PAIRS = {"cubic tether": ("TetherCubic", "Cord"), "neo-Hookean triangle": ("CstNeoHookean", "Rubber")}


def energies(elements: int) -> dict[str, coapt.Energy]:
    """By NumPy; each element has nodes of its own."""
    X = np.tile([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]], (elements, 1))
    nodes = np.arange(3 * elements).reshape(-1, 3)
    return {"cubic tether": coapt.energy(CORD, nodes[:, :2], t=0.3, r=1.2, rho=0.7),
            "neo-Hookean triangle": coapt.energy(RUBBER, nodes, X=X, mu=0.33, h=0.8)}


def in_cpp(runs: int) -> dict[str, np.ndarray]:
    """Nanoseconds of value, gradient, Hessian by the name of the kernel."""
    small = energies(1)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for file, (term, (_, kernel)) in zip(("cord.hpp", "rubber.hpp"), PAIRS.items()):
            (folder / file).write_text(small[term].kernel(kernel))
        subprocess.run(["g++", "-std=c++20", "-O3", "-DNDEBUG", f"-I{folder}", f"-I{ROOT / 'src'}", "-isystem",
                        "/usr/include/eigen3", ROOT / "bench/generated_kernels.cpp",
                        CORE if CORE.exists() else "-lcoapt_core", "-o", folder / "program"], check=True)
        lines = [line.split() for _ in range(runs) for line in subprocess.run(
            [folder / "program", "time"], check=True, capture_output=True, text=True).stdout.splitlines()]
    names = {line[0] for line in lines}
    return {kernel: np.min([np.array(line[1:], float) for line in lines if line[0] == kernel], axis=0) for kernel in names}


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
        for k, what in enumerate(("value", "and gradient", "and Hessian")):
            print(f"| {term} | {what} | {cpp[ours][k]:.1f} | {cpp[generated][k]:.1f} | "
                  f"{cpp[generated][k] / cpp[ours][k]:.2f} | {numpy[term][k]:.0f} |", flush=True)


if __name__ == "__main__":
    main()
