#!/usr/bin/env python3
"""Time of solves against their floor and against another build, one row a case, as a Markdown table.

    bench/speed.py [path of coapt] [--against OTHER] [--seeds N] [--repeats N] [--largest TRIANGLES]

Cases: the generated mitral valve with and without contact, by the method that a scene gets with no option, and the disc and the
airbag. Valves are solved for the seeds 0 to N - 1 of their dimensions (default 3), each by both builds in turn, again and again
(default 3 times, fewer where that takes more than half a minute), of which the fastest counts, and every number is the median over the seeds. CPU s: of the solve with its certificate, to a residual of 1e-8, and of one thread. floor: iterations
times one factorisation and one assembly of the Hessian, both timed in the same run, with those of coarser meshes. shares: of the
time of the processor (`time.cpu_by_phase` of result.json), in percent. 2 threads: time by the clock with two over that with one,
which means something only on a machine that does nothing else. ratio: the time over that of OTHER on the same seed, which may be
the program of the last release.
"""
import argparse
import pathlib
import statistics
import subprocess
import tempfile

from runs import print_header, solved

CASES = [("mitral", "barrier", size) for size in (630, 2500, 10000, 40000, 160000)]
CASES += [("mitral", "none", size) for size in (630, 2500, 10000, 40000)]
CASES += [("disc", "none", size) for size in (10000, 40000)] + [("airbag", "none", size) for size in (2500, 10000)]
PHASES = {"factor": ("factorise", "analyse"), "gradient": ("gradient", "value"), "Hessian": ("hessian",), "solves": ("direction",),
          "collisions": ("collisions",), "certificate": ("certificate",), "coarser": ("coarse_levels",)}
MOST_SECONDS = 30  # by the clock, of all runs on one scene, after which none is repeated


def generated(coapt: str, shape: str, contact: str, triangles: int, seed: int, folder: pathlib.Path) -> pathlib.Path:
    options = ["--triangles", str(triangles), "--contact", contact, "-o", str(folder)]
    options += ["--seed", str(seed)] if shape == "mitral" else []
    subprocess.run([coapt, "generate", shape, *options], check=True, stdout=subprocess.DEVNULL)
    return folder / "scene.json"


def figures(result: dict) -> dict[str, float]:
    time, count = result["time"], result["evaluations"]
    phases = time.get("cpu_by_phase", time["by_phase"])  # builds before the former have the wall time alone
    unit = phases["factorise"] / max(1, count["factorisations"]) + phases["hessian"] / max(1, count["hessian"])
    shares = {name: 100 * sum(phases.get(part, 0) for part in parts) / time["cpu_s"] for name, parts in PHASES.items()}
    return {"iterations": result["iterations"], "factorisations": count["factorisations"], "cpu": time["cpu_s"],
            "floor": result["iterations"] * unit, **shares}


def medians(rows: list[dict[str, float]]) -> dict[str, float]:
    return {name: statistics.median(row[name] for row in rows) for name in rows[0]}


def fastest(programs: list[tuple[str, int]], scene: pathlib.Path, repeats: int) -> list[dict]:
    """For each program and number of threads the result of its fastest run. They run in turn, as a machine has slow minutes."""
    best: list[dict] = [{} for _ in programs]
    spent = 0.0
    for _ in range(repeats):
        for k, (coapt, threads) in enumerate(programs):
            result = solved(coapt, scene, "--tolerance", "1e-8", "--max-seconds", "900", "--no-report", threads=threads)
            if not best[k] or result["time"]["wall_s"] < best[k]["time"]["wall_s"]:
                best[k] = result
            spent += result["time"]["wall_s"]
        if spent > MOST_SECONDS:
            break
    return best


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--against")
    parser.add_argument("--seeds", type=int, default=3)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--largest", type=int, default=40000)
    options = parser.parse_args()
    print_header("case", "triangles", "seeds", "converged", "iterations", "factorisations", "CPU s", "floor s", *PHASES, "2 threads", "ratio")
    for shape, contact, triangles in [case for case in CASES if case[2] <= options.largest]:
        seeds = options.seeds if shape == "mitral" else 1
        rows, converged = [], 0
        for seed in range(seeds):
            with tempfile.TemporaryDirectory() as folder:
                scene = generated(options.coapt, shape, contact, triangles, seed, pathlib.Path(folder))
                others = [(options.against, 1)] if options.against else []
                one, two, *other = fastest([(options.coapt, 1), (options.coapt, 2), *others], scene, options.repeats)
                ratio = {"ratio": one["time"]["cpu_s"] / other[0]["time"]["cpu_s"]} if other else {}
                rows.append(figures(one) | {"two": two["time"]["wall_s"] / one["time"]["wall_s"]} | ratio)
                converged += one["converged"]
        row = medians(rows)
        name = shape + (", contact" if contact == "barrier" else "")
        shares = " | ".join(f"{row[phase]:.0f}" for phase in PHASES)
        ratio = f"{row['ratio']:.2f}" if options.against else ""
        print(f"| {name} | {triangles} | {seeds} | {converged} | {row['iterations']:.0f} | {row['factorisations']:.0f} | "
              f"{row['cpu']:.3f} | {row['floor']:.3f} | {shares} | {row['two']:.2f} | {ratio} |", flush=True)


if __name__ == "__main__":
    main()
