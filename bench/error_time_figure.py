#!/usr/bin/env python3
"""Draws error against run time from a bench.json of `coapt bench`, one curve for each method, as SVG.

    bench/error_time_figure.py BENCH.json OUT.svg [--title TEXT]

Algebraic error (greatest distance of a vertex from the method's own equilibrium on the same mesh) against CPU time of
the solve, on the coarsest mesh. Hollow: a run that stopped before its tolerance. Dashed: what the mesh itself leaves.
"""
import argparse
import json
import pathlib

import matplotlib

matplotlib.use("svg")
from matplotlib import pyplot  # noqa: E402

LEAST_MM = 1e-9  # below this an error is drawn here: it is round-off


def curves(bench: dict) -> dict[str, list[dict]]:
    """Runs on the coarsest mesh that have an algebraic error, by method, in order of time."""
    found: dict[str, list[dict]] = {}
    for run in bench["runs"]:
        if run["mesh"] == 0 and run["errors"]["algebraic"]:
            found.setdefault(run["method"], []).append(run)
    return {method: sorted(runs, key=lambda run: run["cpu_s"]["median"]) for method, runs in found.items()}


def draw(bench: dict, title: str):
    figure, axes = pyplot.subplots(figsize=(7.2, 4.6))
    for number, (method, runs) in enumerate(curves(bench).items()):
        colour = f"C{number}"
        seconds = [run["cpu_s"]["median"] for run in runs]
        errors = [max(run["errors"]["algebraic"]["max_mm"], LEAST_MM) for run in runs]
        axes.loglog(seconds, errors, color=colour, label=method, linewidth=1)
        for run, x, y in zip(runs, seconds, errors):
            axes.plot(x, y, marker="o", color=colour, markerfacecolor=colour if run["converged"] else "white")
    mesh_errors = [run["errors"]["discretisation_mm"] for run in bench["runs"]
                   if run["mesh"] == 0 and run["errors"]["discretisation_mm"]]
    if mesh_errors:
        axes.axhline(mesh_errors[0], color="grey", linestyle="--", linewidth=1, label="error of the mesh")
    axes.set(xlabel="CPU time of the solve [s]", ylabel="greatest algebraic error [mm]", title=title)
    axes.grid(True, which="major", linewidth=0.3)
    axes.legend(fontsize=8)
    figure.tight_layout()
    return figure


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bench", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--title", default="")
    arguments = parser.parse_args()
    bench = json.loads(arguments.bench.read_text(encoding="utf-8"))
    matplotlib.rcParams["svg.hashsalt"] = "coapt"  # the same figure gives the same bytes
    draw(bench, arguments.title or bench["scene"]).savefig(arguments.out, metadata={"Date": None})


if __name__ == "__main__":
    main()
