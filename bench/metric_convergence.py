#!/usr/bin/env python3
"""How the figures of a closed valve converge with the mesh, as a table in Markdown.

    bench/metric_convergence.py [path of coapt] [--sizes 630,2520,10080]

Solves the generated valve that closes and the leaking one of the benchmark at each size (edges are halved from one to the next) and
prints each figure at each size, the order of convergence between the last three, and the limit that they lead to (Aitken); none where
the last two changes have different signs or do not shrink. Chords insert at vertices, so that the valves of two sizes are not quite one.
"""
import argparse
import json
import math
import pathlib
import subprocess
import tempfile

VALVES = {"closes": [], "leaks": ["--preset", "benchmark"]}
FIGURES = ["coaptation_area_mm2", "coaptation_height_mm", "coaptation_length_mm", "orifice_area_mm2", "regurgitant_area_mm2",
           "orifice_film_area_mm2", "tenting_height_mm", "tenting_volume_mm3"]


def order_and_limit(values: list[float]) -> str:
    first, second, third = values[-3:]
    before, after = second - first, third - second
    if after == 0 or before * after <= 0 or abs(after) >= abs(before):
        return "| |"
    order = math.log2(before / after)
    return f"| {order:.2f} | {third + after / (2 ** order - 1):.2f}"


def metrics_of(coapt: str, triangles: int, options: list[str], scratch: pathlib.Path) -> dict:
    subprocess.run([coapt, "generate", "mitral", "--triangles", str(triangles), *options, "-o", str(scratch), "--quiet"], check=True)
    run = subprocess.run([coapt, "solve", str(scratch / "scene.json"), "--no-report", "--quiet", "-o", str(scratch / "result")],
                         check=False)
    if run.returncode != 0:
        raise SystemExit(f"{triangles} triangles: exit code {run.returncode}")
    return json.loads((scratch / "result/result.json").read_text(encoding="utf-8"))["metrics"]


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("coapt", nargs="?", default="build/ci/bin/coapt")
    arguments.add_argument("--sizes", default="630,2520,10080", help="triangles, each four times the one before")
    given = arguments.parse_args()
    sizes = [int(size) for size in given.sizes.split(",")]
    print("| valve | figure |" + "".join(f" {size:,} |" for size in sizes) + " order | limit |")
    print("|---|---|" + "---|" * (len(sizes) + 2))
    with tempfile.TemporaryDirectory() as folder:
        for valve, options in VALVES.items():
            found = [metrics_of(given.coapt, size, options, pathlib.Path(folder) / f"{valve}{size}") for size in sizes]
            for name in FIGURES:
                values = [metrics[name] for metrics in found]
                print(f"| {valve} | `{name}` |" + "".join(f" {value:.2f} |" for value in values)[:-1], order_and_limit(values), "|")


if __name__ == "__main__":
    main()
