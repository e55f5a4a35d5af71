#!/usr/bin/env python3
"""Closes 200 rough valves with no option given, one row of a CSV file each, and sums the rows up.

    bench/rough_valves.py ROWS.csv [path of coapt] [--seeds N] [--cpu-limit SECONDS]   goes on where ROWS.csv ends
    bench/rough_valves.py ROWS.csv --summary                                           prints the Markdown tables

The set is `coapt generate mitral --rough SEED` and `coapt generate tricuspid --rough SEED` for the seeds 1 to N (default
100), without a number of triangles: the seed draws that too, 300 to 20,000, even in the logarithm. Each
is solved by `coapt solve SCENE`; one that has used --cpu-limit of CPU (default 120 s) is asked to stop, and its row says
`cancelled`. A row is written as soon as its valve is through; a run that was broken off is taken up by the same command.

kind, seed: of the generator. triangles: of the mesh that is solved. laws: of the leaflets; "bulk" where one has a bulk
modulus. iterations: on the finest mesh; all_iterations: with the coarse meshes of the cascade. factorisations: on the
finest mesh. cpu_s: of the whole solve with its certificate. floor_s: a factorisation and an assembly for each iteration
on the finest mesh, timed in the same run. stability: the certificate; doubt: 1 where it is one. suspected: 1 where
`solve` warns of other equilibria. exit: of the command.
"""
import argparse
import csv
import json
import pathlib
import signal
import statistics
import subprocess
import tempfile
import time

from real_valves import floor_seconds, run
from runs import print_header

COLUMNS = ["kind", "seed", "triangles", "laws", "status", "residual", "iterations", "all_iterations", "factorisations",
           "cpu_s", "floor_s", "intersections", "orifice_mm2", "stability", "doubt", "suspected", "exit"]
SMALL = 3000
SIZES = (300, 1000, 3000, 8000, 21001)


def used_cpu(process: subprocess.Popen) -> float:
    """Seconds of user and system time, of a process that has not been waited for."""
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / 100


def solved_within(coapt: str, folder: pathlib.Path, limit: float) -> int:
    """Solves the folder's scene into its `out`; the exit code."""
    process = subprocess.Popen([coapt, "solve", str(folder / "scene.json"), "-o", str(folder / "out")],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    asked = False
    while process.poll() is None:
        time.sleep(0.05)
        used = used_cpu(process) if process.poll() is None else 0
        if used > limit and not asked:
            process.send_signal(signal.SIGINT)
            asked = True
        if used > 2 * limit:
            process.kill()
    return process.returncode


def laws_of(folder: pathlib.Path) -> str:
    membranes = json.loads((folder / "valve.json").read_text())["membranes"].values()
    names = {law["type"].removeprefix("cst_").replace("tension_field", "linear") for law in membranes}
    if any("bulk" in law for law in membranes):
        names.add("bulk")
    return " ".join(sorted(names, key=lambda name: (name == "bulk", name)))


def measured(folder: pathlib.Path, code: int) -> dict:
    file = folder / "out/result.json"
    if not file.exists():
        return {"status": "no result", "exit": code}
    result = json.loads(file.read_text())
    metrics, certificate = result["metrics"], result["certificate"]
    levels = result.get("levels") or [result]
    return {"status": result["status"], "residual": f"{result['residual']:.2e}", "iterations": result["iterations"],
            "all_iterations": sum(level["iterations"] for level in levels),
            "factorisations": result["evaluations"]["factorisations"], "cpu_s": f"{result['time']['cpu_s']:.2f}",
            "floor_s": f"{floor_seconds(result):.2f}", "intersections": metrics["intersections"],
            "orifice_mm2": f"{metrics.get('orifice_area_mm2', float('nan')):.2f}", "stability": certificate["stability"],
            "doubt": int(bool(certificate["doubt"])), "suspected": int(result["neighbours"]["suspected"]), "exit": code}


def generated(coapt: str, seeds: int, folder: pathlib.Path) -> list[tuple[int, str, int]]:
    """(triangles, kind, seed) of every valve: small ones first, large ones by seed, so that a run that is broken off
    has some of every size."""
    found = []
    for seed in range(1, seeds + 1):
        for kind in ("mitral", "tricuspid"):
            run(coapt, "generate", kind, "--rough", str(seed), "-o", str(folder))
            lines = (folder / "leaflets.obj").read_text().splitlines()
            found.append((sum(line.startswith("f ") for line in lines), kind, seed))
    return sorted(found, key=lambda valve: valve if valve[0] < SMALL else (SMALL, "", valve[2]))


def solve_all(arguments: argparse.Namespace) -> None:
    known = set()
    if arguments.rows.exists():
        with arguments.rows.open(newline="", encoding="utf-8") as stream:
            known = {(row["kind"], int(row["seed"])) for row in csv.DictReader(stream)}
    else:
        arguments.rows.write_text(",".join(COLUMNS) + "\n", encoding="utf-8")
    with tempfile.TemporaryDirectory() as temporary:
        valves = generated(arguments.coapt, arguments.seeds, pathlib.Path(temporary) / "valve")
        for triangles, kind, seed in valves:
            if (kind, seed) in known:
                continue
            folder = pathlib.Path(temporary) / f"{kind}{seed}"
            run(arguments.coapt, "generate", kind, "--rough", str(seed), "-o", str(folder))
            row = {"kind": kind, "seed": seed, "triangles": triangles, "laws": laws_of(folder)}
            row |= measured(folder, solved_within(arguments.coapt, folder, arguments.cpu_limit))
            with arguments.rows.open("a", newline="", encoding="utf-8") as stream:
                csv.DictWriter(stream, COLUMNS, lineterminator="\n").writerow(row)


def spread(values: list[float]) -> str:
    """Quartiles, and the greatest."""
    if len(values) < 2:
        return ", ".join(f"{value:g}" for value in values)
    low, middle, high = statistics.quantiles(values, n=4, method="inclusive")
    return f"{low:.3g}, {middle:.3g}, {high:.3g}; {max(values):.3g}"


def print_group(name: str, rows: list[dict]) -> None:
    good = [row for row in rows if row["status"] == "converged"]
    number = lambda key: [float(row[key]) for row in good]
    share = [float(row["floor_s"]) / max(float(row["cpu_s"]), 0.01) for row in good if row["floor_s"]]
    firm = sum(row["exit"] == "0" and row["intersections"] == "0" for row in rows)
    print(f"| {name} | {len(rows)} | {len(good)} | {firm} | {spread(number('iterations'))} | "
          f"{spread(number('all_iterations'))} | {spread(number('factorisations'))} | {spread(number('cpu_s'))} | "
          f"{f'{statistics.median(share):.2f}' if share else ''} | {sum(int(row['suspected']) for row in good)} |")


def print_summary(rows: list[dict]) -> None:
    print_header("rough valves", "number", "converged", "and stable, no intersection", "iterations", "with coarse meshes",
                 "factorisations", "CPU s", "floor / CPU", "may have others")
    print_group("all", rows)
    for kind in ("mitral", "tricuspid"):
        print_group(kind, [row for row in rows if row["kind"] == kind])
    for low, high in zip(SIZES, SIZES[1:]):
        group = [row for row in rows if low <= int(row["triangles"]) < high]
        print_group(f"{low:,} to {high - 1:,} triangles".replace("21,000", "20,000"), group)
    for law in ("linear", "orthotropic", "exponential"):
        print_group(f"{law} alone", [row for row in rows if row["laws"].removesuffix(" bulk") == law])
    print_group("two laws or three", [row for row in rows if len(row["laws"].removesuffix(" bulk").split()) > 1])
    print_group("with a bulk modulus", [row for row in rows if row["laws"].endswith("bulk")])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rows", type=pathlib.Path)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--cpu-limit", type=float, default=120)
    parser.add_argument("--summary", action="store_true")
    arguments = parser.parse_args()
    if not arguments.summary:
        solve_all(arguments)
    with arguments.rows.open(newline="", encoding="utf-8") as stream:
        print_summary([row for row in csv.DictReader(stream) if row["residual"]])


if __name__ == "__main__":
    main()
