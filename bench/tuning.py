#!/usr/bin/env python3
"""How well `coapt tune` recovers chord lengths, and how long it takes, as a Markdown table.

    bench/tuning.py [path of coapt] [--runs N] [--largest TRIANGLES] [--seed N]

The generated valve with chords shortened by up to 20 %, half of them, drawn at random, is solved; its closed surface is
the target, and the valve as it was is tuned to it: the 24 trunks by themselves, the same with noise of 0.02 mm on each
coordinate of the target's vertices, and all chords. Closures: solves, first and last included. Lengths that are called
determined are compared with the truth: their greatest error, and with noise the errors over the deviations that are
stated, as root mean square and the greatest. Times: wall time of the whole tuning, the best of N runs.
"""
import argparse
import json
import math
import pathlib
import random
import subprocess
import tempfile

from runs import print_header

NOISE = 0.02  # mm
CASES = [  # triangles, what is tuned, noise of the target [mm], targets
    (250, "trunks", 0.0, 20),
    (250, "trunks", NOISE, 8),
    (250, "all chords", 0.0, 1),
    (2500, "trunks", 0.0, 4),
    (2500, "all chords", 0.0, 1)]


def called(coapt: str, *arguments: object) -> None:
    done = subprocess.run([coapt, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):  # 1: not converged, which the table says
        raise SystemExit(done.stdout + done.stderr)


def shake(file: pathlib.Path, noise: float, draw: random.Random) -> None:
    """Moves every vertex of a Wavefront file."""
    lines = file.read_text().splitlines()
    for k, line in enumerate(lines):
        if line.startswith("v "):
            lines[k] = "v " + " ".join(repr(float(word) + draw.gauss(0, noise)) for word in line.split()[1:4])
    file.write_text("\n".join(lines) + "\n")


def target_of(coapt: str, scene: pathlib.Path, truth: dict[int, float], noise: float,
              draw: random.Random) -> pathlib.Path:
    """The closed surface of the valve whose chords have these factors."""
    edits = [{"type": "chord_length", "chords": [chord], "factor": factor}
             for chord, factor in truth.items() if factor != 1]
    other = scene.parent / "other.json"
    other.write_text(scene.read_text().replace('"terms":', f'"interventions": {json.dumps(edits)},\n  "terms":', 1))
    called(coapt, "solve", other, "-o", scene.parent / "target", "--tolerance", "1e-9", "--no-report")
    file = scene.parent / "target/closed.obj"
    if noise > 0:
        shake(file, noise, draw)
    return file


def tuned(coapt: str, scene: pathlib.Path, target: pathlib.Path, chords: list[int], runs: int) -> dict:
    out = scene.parent / "out"
    found = []
    for _ in range(runs):
        called(coapt, "tune", scene, "--target", target, "-o", out, "--tolerance", "1e-9", "--noise", f"{NOISE}mm",
               "--change-weight", "0", "--only", ",".join(f"chords[{chord}]" for chord in chords))
        found.append(json.loads((out / "tuning.json").read_text()))
    return min(found, key=lambda tuning: tuning["seconds"])


def newton_iterations(tuning: dict) -> int:
    return (tuning["before"]["iterations"] + tuning["after"]["iterations"]
            + sum(trial["iterations"] for trial in tuning["history"]))


def spread(values: list[float], form: str) -> str:
    least, most = form.format(min(values)), form.format(max(values))
    return least if least == most else f"{least} to {most}"


def print_case(coapt: str, folder: pathlib.Path, case: tuple[int, str, float, int],
               options: argparse.Namespace) -> None:
    triangles, what, noise, targets = case
    called(coapt, "generate", "mitral", "--preset", "benchmark", "--triangles", triangles, "-o", folder)
    chords = json.loads((folder / "valve.json").read_text())["chords"]
    chosen = [k for k, chord in enumerate(chords) if what != "trunks" or "papillary" in chord["from"]]
    tunings, errors, ratios = [], [], []
    for number in range(targets):
        draw = random.Random(1000 * options.seed + number)
        truth = {chord: draw.uniform(0.8, 1) if draw.random() < 0.5 else 1.0 for chord in chosen}
        target = target_of(coapt, folder / "scene.json", truth, noise, draw)
        tunings.append(tuned(coapt, folder / "scene.json", target, chosen, options.runs))
        for chord, length in zip(chosen, tunings[-1]["lengths"]):
            if length["determined"]:
                errors.append(abs(length["after_mm"] - truth[chord] * length["before_mm"]))
                ratios.append(errors[-1] / length["standard_deviation_mm"])
    closures = [tuning["solves"] for tuning in tunings]
    after = [tuning["rms_distance_mm"]["after"] for tuning in tunings]
    fitted = sum(distance < 1e-3 or tuning["explained_by_noise"] for distance, tuning in zip(after, tunings))
    stated = ""
    if noise > 0 and ratios:
        stated = f"{math.sqrt(sum(ratio**2 for ratio in ratios) / len(ratios)):.2f}, {max(ratios):.1f}"
    print(f"| {triangles} | {what} | {noise or 'none'} | {fitted} of {targets} | "
          f"{spread(closures, '{}')} ({sum(closures) / targets:.1f}) | "
          f"{spread([newton_iterations(tuning) for tuning in tunings], '{}')} | "
          f"{spread([tuning['rms_distance_mm']['before'] for tuning in tunings], '{:.2f}')} | "
          f"{spread(after, '{:.1g}')} | "
          f"{spread([sum(bool(length['determined']) for length in tuning['lengths']) for tuning in tunings], '{}')} "
          f"of {len(chosen)} | {f'{max(errors):.1g}' if errors else ''} | {stated} | "
          f"{spread([tuning['seconds'] for tuning in tunings], '{:.1f}')} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--largest", type=int, default=2500)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    print_header("triangles", "tuned", "noise [mm]", "fitted or explained", "closures (mean)", "Newton iterations",
                 "rms distance before [mm]", "after [mm]", "determined", "their greatest error [mm]",
                 "error / deviation: rms, greatest", "s")
    for case in CASES:
        if case[0] <= options.largest:
            with tempfile.TemporaryDirectory() as folder:
                print_case(options.coapt, pathlib.Path(folder), case, options)


if __name__ == "__main__":
    main()
