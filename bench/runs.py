"""What the benchmarks of whole solves share: their command line, and one run of the command."""
import argparse
import json
import os
import pathlib
import subprocess


# OpenBLAS, which other factorisations bring along, starts a thread for each processor with the program, and these wait for work
# at the cost of 0.07 to 0.09 CPU s: more than a small solve takes.
ENVIRONMENT = os.environ | {"OPENBLAS_NUM_THREADS": "1"}


def parsed_arguments(description: str, **more: float) -> argparse.Namespace:
    """Path of coapt, --runs, --largest, and an option with a default for each of `more`."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--largest", type=int, default=160000)
    for name, default in more.items():
        parser.add_argument("--" + name.replace("_", "-"), type=float, default=default)
    return parser.parse_args()


def knows_threads(coapt: str) -> bool:
    """Builds before `--threads` solve in one."""
    said = subprocess.run([coapt, "solve", "--help"], stdout=subprocess.PIPE, text=True, check=False).stdout
    return "--threads" in said


def solved(coapt: str, scene: pathlib.Path, *arguments: str, threads: int = 1) -> dict:
    out = scene.parent / "out"
    (out / "result.json").unlink(missing_ok=True)  # never that of another scene
    asked = ["--threads", str(threads)] if knows_threads(coapt) else []
    run = subprocess.run([coapt, "solve", str(scene), "-o", str(out), *asked, *arguments], stdout=subprocess.DEVNULL,
                         stderr=subprocess.PIPE, text=True, check=False, env=ENVIRONMENT)
    if not (out / "result.json").exists():
        raise SystemExit(f"{scene}: {run.stderr}")
    return json.loads((out / "result.json").read_text())


def print_header(*columns: str) -> None:
    print("| " + " | ".join(columns) + " |")
    print("|" + "---|" * len(columns))
