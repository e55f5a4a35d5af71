#!/usr/bin/env python3
"""Times newton on the default membrane with the command itself and prints a Markdown table.

    bench/newton.py [path of coapt] [--runs N] [--largest TRIANGLES]

Cases: the generated mitral valve under follower pressure without contact, directly and by the cascade; the
pressurised disc; the square airbag. CPU time of the solve (best of N runs) to a residual of 1e-8, and what it is
in units of one factorisation and one assembly of the Hessian measured in the same run. Up to 10,000 triangles the
valve's ratio to preconditioned lbfgs, and up to 2,500 to plain lbfgs, is given too.
"""
import pathlib
import subprocess
import tempfile

from runs import parsed_arguments, print_header, solved

VALVES = [625, 2500, 10000, 40000, 160000]
OTHERS = [("disc", 10086), ("disc", 40344), ("airbag", 2450), ("airbag", 10082)]


def scene_of(coapt: str, shape: str, triangles: int, folder: pathlib.Path) -> pathlib.Path:
    preset = ["--preset", "benchmark"] if shape == "mitral" else []
    subprocess.run([coapt, "generate", shape, *preset, "--triangles", str(triangles), "--contact", "none", "-o",
                    str(folder)], check=True,
                   stdout=subprocess.DEVNULL)
    return folder / "scene.json"


def best(coapt: str, scene: pathlib.Path, runs: int, *arguments: str) -> dict:
    results = [solved(coapt, scene, "--tolerance", "1e-8", "--max-seconds", "300", *arguments) for _ in range(runs)]
    return min(results, key=lambda result: result["time"]["cpu_s"])


def variant(scene: pathlib.Path, key: str) -> pathlib.Path:
    text = scene.read_text()
    other = scene.with_name("variant.json")
    other.write_text(text.replace('"solver": {', '"solver": { ' + key + ","))
    if other.read_text() == text:
        raise SystemExit("the scene has no solver to change")
    return other


def row(name: str, result: dict) -> str:
    phases, count = result["time"]["by_phase"], result["evaluations"]
    factorisations = count["factorisations"]
    unit = (phases["factorise"] / max(1, factorisations) + phases["hessian"] / max(1, count["hessian"]))
    cpu = result["time"]["cpu_s"]
    return (f"| {name} | {result['mesh']['triangles']} | {result['status']} | {result['residual']:.0e} | "
            f"{result['iterations']} | {factorisations} | {cpu:.3f} | {1000 * unit:.2f} | {cpu / unit:.0f} |")


def main() -> None:
    options = parsed_arguments(__doc__)
    print_header("case", "triangles", "status", "residual", "iterations", "factorisations", "CPU s",
                 "factorisation + assembly ms", "CPU in these")
    for triangles in [size for size in VALVES if size <= options.largest]:
        with tempfile.TemporaryDirectory() as folder:
            runs = options.runs if triangles <= 10000 else 1
            scene = scene_of(options.coapt, "mitral", triangles, pathlib.Path(folder))
            direct = best(options.coapt, scene, runs)
            print(row("valve", direct), flush=True)
            if triangles > 625:
                print(row("valve, cascade", best(options.coapt, variant(scene, '"cascade": true'), runs)), flush=True)
            peers = []
            if triangles <= 10000:
                peers.append(("preconditioned lbfgs", variant(scene, '"preconditioned": true')))
            if triangles <= 2500:
                peers.append(("lbfgs", scene))
            for name, peer in peers:
                result = best(options.coapt, peer, 1, "--solver", "lbfgs")
                print(f"| valve, {name} | {triangles} | {result['status']} | {result['residual']:.0e} | "
                      f"{result['iterations']} | | {result['time']['cpu_s']:.3f} | | "
                      f"{result['time']['cpu_s'] / direct['time']['cpu_s']:.1f} times newton |", flush=True)
    for shape, triangles in [other for other in OTHERS if other[1] <= options.largest]:
        with tempfile.TemporaryDirectory() as folder:
            scene = scene_of(options.coapt, shape, triangles, pathlib.Path(folder))
            print(row(shape, best(options.coapt, scene, options.runs)), flush=True)


if __name__ == "__main__":
    main()
