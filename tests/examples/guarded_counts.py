#!/usr/bin/env python3
"""Holds iterations and factorisations of shared valves and of rough ones below the limits of guarded_counts.csv.

    guarded_counts.py COAPT [--data FOLDER] [--write]

--write measures them and writes the table: today's counts and a quarter more. Valves that FOLDER (the shared data) lacks
are skipped with a message.
"""
import argparse
import csv
import math
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "bench"))
from real_valves import run, solved  # noqa: E402

TABLE = pathlib.Path(__file__).with_name("guarded_counts.csv")
SHARED = ["bhv-trileaflet/valve_coarse.json", "bhv-trileaflet/valve_fine.json", "mitral-ct-normal1/valve_n32.json",
          "mitral-ct-normal1/valve_n64.json", "mitral-ct-normal1/valve_n128.json",
          "trivalve11-healthy/valve_coarse.json", "trivalve11-healthy/valve.json"]
VALVES = SHARED + [f"rough {kind} {seed}" for seed in (1, 2, 4, 5, 6) for kind in ("mitral", "tricuspid")]


def counts(coapt: str, valve: str, data: pathlib.Path) -> tuple[int, int] | None:
    """Iterations and factorisations to the end; None where the valve is not there."""
    with tempfile.TemporaryDirectory() as folder:
        if valve in SHARED:
            if not (data / valve).exists():
                return None
            run(coapt, "import", str(data / valve), "-o", folder)
        else:
            _, kind, seed = valve.split()
            run(coapt, "generate", kind, "--rough", seed, "--triangles", "900", "-o", folder)
        result = solved(coapt, pathlib.Path(folder), 600)
    if not result["converged"]:
        raise SystemExit(f"{valve}: {result['status']} at residual {result['residual']:.1e}")
    return result["iterations"], result["evaluations"]["factorisations"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt")
    parser.add_argument("--data", type=pathlib.Path, default=ROOT.parent / "shared/data")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    if arguments.write:
        with TABLE.open("w", newline="") as file:
            rows = csv.writer(file, lineterminator="\n")
            rows.writerow(["valve", "most_iterations", "most_factorisations"])
            for valve in VALVES:
                found = counts(arguments.coapt, valve, arguments.data)
                if found is None:
                    raise SystemExit(f"{valve} is not in {arguments.data}: the table was not made")
                rows.writerow([valve, *(math.ceil(1.25 * count) for count in found)])
        return
    failures = []
    with TABLE.open() as file:
        for row in csv.DictReader(file):
            found = counts(arguments.coapt, row["valve"], arguments.data)
            if found is None:
                print(f"skipped: {row['valve']} is not in {arguments.data}")
                continue
            limits = int(row["most_iterations"]), int(row["most_factorisations"])
            print(f"{row['valve']}: {found[0]} iterations, {found[1]} factorisations; at most {limits[0]} and {limits[1]}")
            if found[0] > limits[0] or found[1] > limits[1]:
                failures.append(row["valve"])
    if failures:
        raise SystemExit("more than guarded: " + ", ".join(failures))


if __name__ == "__main__":
    main()
