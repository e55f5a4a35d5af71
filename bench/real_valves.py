#!/usr/bin/env python3
"""Closes valves as people have them, with no option given, and prints Markdown tables.

    bench/real_valves.py [path of coapt] [--data FOLDER] [--seeds N] [--triangles N] [--wide] [--before COAPT] [--branches N]
                         [--direct] [--only TEXT]

What `coapt import FILE` and `coapt solve` do with each valve of FOLDER (the shared data), `coapt generate --rough` and
`coapt solve` with N seeds each of the mitral and the tricuspid kind (default 10, of 900 triangles), and --wide: the
tricuspid valves with their annulus made wider and their tips moved by several millimetres, as in a diseased heart. A
solve is given --max-seconds (default 300). Iterations are those on the finest mesh; the floor is a factorisation and an
assembly for each of them, timed in the same run, over the CPU time; distances are to the published closed surface, from
ours to it and from it to ours. --before: another coapt solves the same scenes, for a column beside ours. --branches: a
column with the range of the orifice over other equilibria, from N perturbed starts of each kind (N times the work).
--direct: without the damped path. --only: the shared valves whose path contains TEXT.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

from runs import print_header

VALVES = ["bhv-trileaflet/valve_coarse.json", "bhv-trileaflet/valve_fine.json", "mitral-ct-normal1/valve_n32.json",
          "mitral-ct-normal1/valve_n64.json", "mitral-ct-normal1/valve_n128.json",
          "trivalve11-healthy/valve_coarse.json", "trivalve11-healthy/valve.json"]
# Factor on the annulus in its plane, and how far the tips move [mm].
WIDE = [(1.15, (3, -2, -2)), (1.25, (4, 0, -4)), (1.1, (-3, 3, 2))]


def run(coapt: str, *arguments: str) -> subprocess.CompletedProcess:
    return subprocess.run([coapt, *arguments], capture_output=True, text=True, check=False)


def solved(coapt: str, folder: pathlib.Path, seconds: float, *options: str) -> dict:
    out = folder / "out"
    run(coapt, "solve", str(folder / "scene.json"), "-o", str(out), "--max-seconds", str(seconds), *options)
    return json.loads((out / "result.json").read_text())


def widen(folder: pathlib.Path, factor: float, move: tuple[float, float, float]) -> None:
    """Writes the closed annulus wider and the closed tips elsewhere into the folder's valve.json."""
    file = folder / "valve.json"
    valve = json.loads(file.read_text())
    ring = valve["annulus_closed"]
    centre = [statistics.fmean(point[c] for point in ring) for c in range(3)]
    valve["annulus_closed"] = [[centre[c] + (factor if c < 2 else 1) * (p[c] - centre[c]) for c in range(3)]
                               for p in ring]
    tips = valve.get("papillary_closed") or valve["papillary"]
    valve["papillary_closed"] = [[p[c] + move[c] for c in range(3)] for p in tips]
    file.write_text(json.dumps(valve))


def distances(result: dict) -> str:
    found = result.get("distance_to_reference")
    if not found:
        return ""
    there, back = found["to_reference"], found["from_reference"]
    return f"{there['mean_mm']:.3f}, {back['mean_mm']:.3f}; {there['p95_mm']:.3f}, {back['p95_mm']:.3f}"


def spread(result: dict) -> str:
    """The other equilibria that --branches found, with their orifice [mm2]."""
    branches = result.get("branches")
    if not branches:
        return ""
    orifice = branches["others"].get("orifice_area_mm2")
    found = f"{len(branches['equilibria']) - 1} in {branches['starts']} starts"
    return f"{found}: {orifice['lowest']:.2f} to {orifice['highest']:.2f}" if orifice else found


def floor_seconds(result: dict) -> float:
    """CPU time of a factorisation and an assembly for each iteration on the finest mesh."""
    counts, time = result["evaluations"], result["time"]
    phases = time["by_phase"]  # in wall time
    factorised = phases.get("factorise", 0) / max(counts["factorisations"], 1)
    assembled = phases.get("hessian", 0) / max(counts["hessian"], 1)
    return result["iterations"] * (factorised + assembled) * time["cpu_s"] / max(time["wall_s"], 1e-9)


def cells(result: dict) -> list[str]:
    counts, metrics, time = result["evaluations"], result["metrics"], result["time"]
    floor = floor_seconds(result) / max(time["cpu_s"], 1e-9)
    return [result["status"], f"{result['residual']:.0e}", str(result["iterations"]), str(counts["factorisations"]),
            f"{time['cpu_s']:.2f}", f"{floor:.2f}", str(metrics["intersections"]),
            f"{metrics.get('orifice_area_mm2', float('nan')):.2f}", distances(result),
            result["certificate"]["stability"]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--data", type=pathlib.Path, default="../shared/data")
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--triangles", type=int, default=900)
    parser.add_argument("--max-seconds", type=float, default=300)
    parser.add_argument("--wide", action="store_true")
    parser.add_argument("--before")
    parser.add_argument("--branches", type=int, default=0)
    parser.add_argument("--direct", action="store_true")
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    columns = ["valve", "triangles", "status", "residual", "iterations", "factorisations", "CPU s", "floor / CPU",
               "intersections", "orifice mm2", "mean; 95 % mm, to and from", "stability"]
    path = ["--damped-steps", "0"] if arguments.direct else []
    search = ["--branches", str(arguments.branches)] if arguments.branches else []
    if search:
        columns.append("others: orifice mm2")
    if arguments.before:
        columns.append("before: status, iterations, CPU s")
    print_header(*columns)
    seen = []

    def row(name: str, folder: pathlib.Path) -> dict:
        result = solved(arguments.coapt, folder, arguments.max_seconds, *path)
        line = [name, str(result["mesh"]["triangles"]), *cells(result)]
        if search:
            line.append(spread(solved(arguments.coapt, folder, arguments.max_seconds, *path, *search)))
        if arguments.before:
            before = solved(arguments.before, folder, arguments.max_seconds, *path)
            line.append(f"{before['status']}, {before['iterations']}, {before['time']['cpu_s']:.2f}")
        print("| " + " | ".join(line) + " |", flush=True)
        return result

    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary) / "valve"
        for valve in [valve for valve in VALVES if arguments.only in valve]:
            if not (arguments.data / valve).exists():
                print(f"skipped: {valve} is not in {arguments.data}")
                continue
            run(arguments.coapt, "import", str(arguments.data / valve), "-o", str(folder))
            row(valve.removesuffix(".json").replace("/valve_", " ").replace("/valve", " full"), folder)
        coarse = arguments.data / "trivalve11-healthy/valve_coarse.json"
        for factor, move in WIDE if arguments.wide and coarse.exists() else []:
            run(arguments.coapt, "import", str(coarse), "-o", str(folder))
            widen(folder, factor, move)
            row(f"trivalve11 coarse, {factor} as wide, tips {move} mm", folder)
        for seed in range(1, arguments.seeds + 1):
            for kind in ("mitral", "tricuspid"):
                run(arguments.coapt, "generate", kind, "--rough", str(seed), "--triangles", str(arguments.triangles),
                    "-o", str(folder))
                seen.append(row(f"rough {kind} {seed}", folder))
    if seen:
        good = [result for result in seen if result["converged"]]
        iterations = sorted(result["iterations"] for result in good)
        print(f"\nRough valves: {len(good)} of {len(seen)} converged; iterations: median "
              f"{statistics.median(iterations)}, greatest {iterations[-1]}; CPU s: median "
              f"{statistics.median(result['time']['cpu_s'] for result in good):.2f}")


if __name__ == "__main__":
    main()
