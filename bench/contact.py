#!/usr/bin/env python3
"""Times closures of the generated mitral valve with barrier contact and prints Markdown tables.

    bench/contact.py [path of coapt] [--runs N] [--largest TRIANGLES] [--seeds N] [--valves FOLDER]

First table: the mean valve on finer and finer meshes, directly and by the cascade, to a residual of 1e-8 under
follower pressure. CPU time of the solve (best of N runs), what it is in units of one factorisation and one assembly
of the Hessian measured in the same run, and the share of contact: candidates, distances and derivatives stand in
"gradient" and "hessian", so that share is what these and "collisions" take more than in a run without contact, an
upper bound. Second table: random valves (seeds 1 to N) of 625 triangles, iterations and times. FOLDER may hold
valve JSONs, such as the published ones, to be imported and solved too.
"""
import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

VALVES = [625, 2500, 10000, 40000, 160000]


def run(coapt: str, scene: pathlib.Path, seconds: float) -> dict:
    subprocess.run([coapt, "solve", str(scene), "-o", str(scene.parent / "out"), "--tolerance", "1e-8",
                    "--max-seconds", str(seconds)], stdout=subprocess.DEVNULL, check=False)
    return json.loads((scene.parent / "out" / "result.json").read_text())


def best(coapt: str, scene: pathlib.Path, runs: int, seconds: float) -> dict:
    return min((run(coapt, scene, seconds) for _ in range(runs)), key=lambda result: result["time"]["cpu_s"])


def generated(coapt: str, folder: pathlib.Path, triangles: int, seed: int, contact: str) -> pathlib.Path:
    subprocess.run([coapt, "generate", "mitral", "--preset", "benchmark", "--triangles", str(triangles), "--seed", str(seed), "--contact",
                    contact, "-o", str(folder)], check=True, stdout=subprocess.DEVNULL)
    return folder / "scene.json"


def with_cascade(scene: pathlib.Path) -> pathlib.Path:
    other = scene.with_name("cascade.json")
    other.write_text(scene.read_text().replace('"solver": {', '"solver": { "cascade": true,'))
    return other


def contact_share(result: dict, free: dict) -> float:
    phases, free_phases = result["time"]["by_phase"], free["time"]["by_phase"]
    count, free_count = result["evaluations"], free["evaluations"]
    seconds = phases.get("collisions", 0)
    for phase in ("gradient", "hessian"):
        seconds += phases[phase] - free_phases[phase] / free_count[phase] * count[phase]
    return seconds / sum(phases.values())


def row(name: str, result: dict, free: dict | None) -> str:
    phases, count = result["time"]["by_phase"], result["evaluations"]
    unit = (phases["factorise"] / max(1, count["factorisations"]) + phases["hessian"] / max(1, count["hessian"]))
    cpu = result["time"]["cpu_s"]
    share = f"{100 * contact_share(result, free):.0f} %" if free else ""
    pairs = [term["counters"]["elements"] for term in result["terms"] if term["type"] == "contact_barrier"][0]
    return (f"| {name} | {result['mesh']['triangles']} | {result['status']} | {result['residual']:.0e} | "
            f"{result['metrics']['intersections']} | {pairs} | {result['iterations']} | {cpu:.3f} | "
            f"{1000 * unit:.2f} | {cpu / unit:.0f} | {share} |")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--largest", type=int, default=160000)
    parser.add_argument("--seeds", type=int, default=200)
    parser.add_argument("--valves", type=pathlib.Path)
    options = parser.parse_args()
    header = ("| case | triangles | status | residual | intersections | pairs in contact | iterations | CPU s | "
              "factorisation + assembly ms | CPU in these | share of contact |")
    print(header + "\n|" + "---|" * 11)
    for triangles in [size for size in VALVES if size <= options.largest]:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            runs = options.runs if triangles <= 10000 else 1
            scene = generated(options.coapt, folder / "barrier", triangles, 0, "barrier")
            free = best(options.coapt, generated(options.coapt, folder / "free", triangles, 0, "none"), runs, 600)
            print(row("valve", best(options.coapt, scene, runs, 900), free), flush=True)
            if triangles > 625:
                print(row("valve, cascade", best(options.coapt, with_cascade(scene), runs, 900), free), flush=True)
    if options.valves:
        for valve in sorted(options.valves.glob("*.json")):
            with tempfile.TemporaryDirectory() as name:
                folder = pathlib.Path(name)
                subprocess.run([options.coapt, "import", str(valve), "-o", str(folder), "--young", "0.05 MPa",
                                "--chord-young", "40 MPa"], check=True, stdout=subprocess.DEVNULL)
                print(row(valve.stem, best(options.coapt, folder / "scene.json", 1, 900), None), flush=True)
    if options.seeds == 0:
        return
    results = []
    with tempfile.TemporaryDirectory() as name:
        for seed in range(1, options.seeds + 1):
            scene = generated(options.coapt, pathlib.Path(name) / str(seed), 625, seed, "barrier")
            results.append(run(options.coapt, scene, 60))
    iterations = sorted(result["iterations"] for result in results)
    times = sorted(result["time"]["cpu_s"] for result in results)
    print("\n| random valves | converged to 1e-8 | with intersections | iterations: median, 95 %, most | "
          "CPU s: median, 95 %, most |\n|---|---|---|---|---|")
    last = lambda values: f"{statistics.median(values):.3g}, {values[int(0.95 * len(values))]:.3g}, {values[-1]:.3g}"
    print(f"| {len(results)} | {sum(result['converged'] for result in results)} | "
          f"{sum(result['metrics']['intersections'] > 0 for result in results)} | {last(iterations)} | {last(times)} |")


if __name__ == "__main__":
    main()
