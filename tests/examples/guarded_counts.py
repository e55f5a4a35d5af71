#!/usr/bin/env python3
"""Holds iterations, factorisations and gradients of shared valves, rough ones and shapes below the limits of guarded_counts.csv.

    guarded_counts.py COAPT [--data FOLDER] [--write]

--write measures them and writes the table: today's counts and a tenth more. Valves that FOLDER (the shared data) lacks
are skipped with a message. Where the last digits decide on the counts (SCATTERED), they are medians of several runs whose
pressures differ by parts in 1e12.
"""
import argparse
import csv
import math
import pathlib
import re
import statistics
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "bench"))
from real_valves import run, solved  # noqa: E402

TABLE = pathlib.Path(__file__).with_name("guarded_counts.csv")
SHARED = ["bhv-trileaflet/valve_coarse.json", "bhv-trileaflet/valve_fine.json", "mitral-ct-normal1/valve_n32.json",
          "mitral-ct-normal1/valve_n64.json", "mitral-ct-normal1/valve_n128.json",
          "trivalve11-healthy/valve_coarse.json", "trivalve11-healthy/valve.json"]
SHAPES = ["disc 4000", "airbag 2500", "mitral 630", "mitral 2500"]
VALVES = SHARED + SHAPES + [f"rough {kind} {seed}" for seed in (1, 2, 4, 5, 6) for kind in ("mitral", "tricuspid")]

# By 20 runs that differ in such digits its gradients scatter from 134 to 211 (docs/decisions/023-multifrontal.md).
SCATTERED = {"trivalve11-healthy/valve.json": [0, 1e-12, -1e-12, 3e-12, -3e-12]}


def scale_pressures(folder: pathlib.Path, factor: float) -> None:
    """Of the loads of the scene in the folder, which has comments and is no plain JSON."""
    file = folder / "scene.json"
    text, count = re.subn(r'("type": "load_pressure", "value": ")(\S+)',
                          lambda match: match[1] + repr(float(match[2]) * factor), file.read_text())
    if count == 0:
        raise SystemExit(f"{file}: no load_pressure with a value behind its type")
    file.write_text(text)


def counts(coapt: str, valve: str, data: pathlib.Path) -> tuple[int, int, int] | None:
    """Iterations, factorisations and gradients to the end; None where the valve is not there."""
    runs = [counts_of_run(coapt, valve, data, 1 + change) for change in SCATTERED.get(valve, [0])]
    return None if None in runs else tuple(round(statistics.median(count)) for count in zip(*runs))


def counts_of_run(coapt: str, valve: str, data: pathlib.Path, pressures: float) -> tuple[int, int, int] | None:
    """The same of one run with all pressures times a factor."""
    with tempfile.TemporaryDirectory() as folder:
        if valve in SHARED:
            if not (data / valve).exists():
                return None
            run(coapt, "import", str(data / valve), "-o", folder)
        elif valve in SHAPES:
            shape, triangles = valve.split()
            run(coapt, "generate", shape, "--triangles", triangles, "-o", folder)
        else:
            _, kind, seed = valve.split()
            run(coapt, "generate", kind, "--rough", seed, "--triangles", "900", "-o", folder)
        if pressures != 1:
            scale_pressures(pathlib.Path(folder), pressures)
        result = solved(coapt, pathlib.Path(folder), 600)
    if not result["converged"]:
        raise SystemExit(f"{valve}: {result['status']} at residual {result['residual']:.1e}")
    evaluations = result["evaluations"]
    return result["iterations"], evaluations["factorisations"], evaluations["gradient"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt")
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared/data")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    if arguments.write:
        with TABLE.open("w", newline="") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(["valve", "most_iterations", "most_factorisations", "most_gradients"])
            for valve in VALVES:
                found = counts(arguments.coapt, valve, arguments.data)
                if found is None:
                    raise SystemExit(f"{valve} is not in {arguments.data}: the table was not made")
                rows.writerow([valve, *(math.ceil(1.1 * count) for count in found)])
        return
    failures = []
    with TABLE.open() as file:
        for row in csv.DictReader(file):
            found = counts(arguments.coapt, row["valve"], arguments.data)
            if found is None:
                print(f"skipped: {row['valve']} is not in {arguments.data}")
                continue
            limits = [int(row[f"most_{what}"]) for what in ("iterations", "factorisations", "gradients")]
            print(f"{row['valve']}: iterations, factorisations, gradients {found}; at most {limits}")
            if any(count > most for count, most in zip(found, limits)):
                failures.append(row["valve"])
    if failures:
        raise SystemExit("more than guarded: " + ", ".join(failures))


if __name__ == "__main__":
    main()
