#!/usr/bin/env python3
"""Whether two builds of the command give the same numbers, to the last digit: what proves a commit that only moves code.

    same_numbers.py BEFORE AFTER [SCENE...]     two programs `coapt`; scenes: by default all those of examples
        --no-stress: without `coapt stress --quick`

Both solve every scene and run the quick rows of the stress matrix. Compared are the exit codes and the files that each writes
(positions, metrics, histories, result.json, stress.json) byte by byte, without times, memory and pages, and without how far a run got that
the clock ended. Lists what differs.
Exit code: 0 nothing does, 1 something does, 2 a program or scene that is not there. Keep the program of before, as a build overwrites it:
`cp build/ci/bin/coapt before`.
"""
import argparse
import csv
import io
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
TIMES = {"time", "wall_s", "cpu_s", "time_s", "seconds", "peak_memory_mb"}  # keys of JSON, columns of CSV
SECONDS = re.compile(r"\d[\d.e+-]* [um]?s\b")  # in messages
MOST_SHOWN = 20  # differences of one file


def without_times(value: object) -> object:
    """Without what no two runs have in common: times, a figure that is a time, and the state in which the clock ended a run."""
    if isinstance(value, list):
        return [without_times(each) for each in value]
    if isinstance(value, dict):
        timed = {"figure", "message"} if value.get("unit") == "s" else set()
        if value.get("status") == "time_limit":
            timed |= {"figure", "message", "residual", "iterations"}
        return {key: without_times(each) for key, each in value.items() if key not in TIMES | timed}
    return SECONDS.sub("... s", value) if isinstance(value, str) else value


def leaves(value: object, at: str = "") -> dict[str, str]:
    """Place and text of every value; of a number the digits that read back to the same bits."""
    if isinstance(value, dict) and value:
        return {place: text for key, each in value.items() for place, text in leaves(each, f"{at}.{key}").items()}
    if isinstance(value, list) and value:
        return {place: text for k, each in enumerate(value) for place, text in leaves(each, f"{at}[{k}]").items()}
    return {at.lstrip("."): json.dumps(value)}


def contents(path: pathlib.Path) -> dict[str, str]:
    """What of a file is compared, by place."""
    text = path.read_text(encoding="utf-8", errors="surrogateescape")
    if path.suffix == ".json":
        return leaves(without_times(json.loads(text)))
    if path.suffix == ".csv":
        rows = list(csv.reader(io.StringIO(text)))
        kept = [k for k, name in enumerate(rows[0]) if name not in TIMES] if rows else []
        return {f"row {number}": ",".join(row[k] for k in kept if k < len(row)) for number, row in enumerate(rows)}
    return {f"line {number}": line for number, line in enumerate(text.splitlines(), 1)}


def is_compared(path: pathlib.Path) -> bool:
    return path.is_file() and path.suffix != ".html" and path.name != "stress.csv"  # stress.json has the same rows


def differences(before: pathlib.Path, after: pathlib.Path) -> list[str]:
    """Of two folders of results."""
    names = {path.relative_to(folder) for folder in (before, after) for path in folder.rglob("*") if is_compared(path)}
    found = []
    for name in sorted(names):
        if not (before / name).exists() or not (after / name).exists():
            found.append(f"{name}: is written by {'AFTER' if (after / name).exists() else 'BEFORE'} alone")
            continue
        if (before / name).read_bytes() == (after / name).read_bytes():
            continue
        old, new = contents(before / name), contents(after / name)
        places = [place for place in dict.fromkeys([*old, *new]) if old.get(place) != new.get(place)]
        found += [f"{name}: {place}: {old.get(place, 'nothing')}, then {new.get(place, 'nothing')}" for place in places[:MOST_SHOWN]]
        if len(places) > MOST_SHOWN:
            found.append(f"{name}: and {len(places) - MOST_SHOWN} more")
    return found


def compared(programs: list[str], arguments: list[str]) -> list[str]:
    """Runs both programs with the same arguments, each into a folder of its own of the same name."""
    with tempfile.TemporaryDirectory() as scratch:
        folders, codes = [], []
        for name, program in zip(("before", "after"), programs):
            folder = pathlib.Path(scratch) / name
            folder.mkdir()
            run = subprocess.run([program, *arguments, "-o", "out"], cwd=folder, capture_output=True, text=True)
            folders.append(folder)
            codes.append(run.returncode)
        found = [] if codes[0] == codes[1] else [f"exit code {codes[0]}, then {codes[1]}"]
        found += differences(*folders)
        if not any(is_compared(path) for folder in folders for path in folder.rglob("*")):
            found.append(f"neither program wrote anything: {' '.join(arguments)}")
        return found


def scenes_of(folder: pathlib.Path) -> list[pathlib.Path]:
    return [path for path in sorted(folder.glob("*/*.json")) if '"terms"' in path.read_text(encoding="utf-8")]


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("before")
    arguments.add_argument("after")
    arguments.add_argument("scenes", nargs="*", type=pathlib.Path, metavar="SCENE")
    arguments.add_argument("--no-stress", action="store_true", help="without coapt stress --quick")
    given = arguments.parse_intermixed_args()
    scenes = given.scenes or scenes_of(ROOT / "examples")
    missing = [str(path) for path in (given.before, given.after, *scenes) if not pathlib.Path(path).is_file()]
    if missing:
        print("\n".join(f"{path}: no such file" for path in missing), file=sys.stderr)
        return 2
    programs = [str(pathlib.Path(program).resolve()) for program in (given.before, given.after)]
    tasks = {str(scene): ["solve", str(scene.resolve())] for scene in scenes}
    if not given.no_stress:
        tasks["stress --quick"] = ["stress", "--quick"]
    differing = 0
    for name, task in tasks.items():
        found = compared(programs, task)
        differing += bool(found)
        print(f"{name}: {'differs' if found else 'the same'}", *(f"  {line}" for line in found), sep="\n", flush=True)
    print(f"{differing} of {len(tasks)} differ" if differing else f"{len(tasks)} the same to the last digit")
    return 1 if differing else 0


if __name__ == "__main__":
    sys.exit(main())
