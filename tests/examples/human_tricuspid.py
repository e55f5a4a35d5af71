"""The example of the human tricuspid valve as its README tells it: its scene is made, solved and registered.

    human_tricuspid.py COAPT SHARED_DATA_FOLDER EXAMPLE_FOLDER

Exit code 77, "skipped", where the data is not there. The motion is known, so is the distance in the valve's own frame (the table of
the README): registration may make the distance less, not more.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77


def main() -> int:
    coapt, shared, example = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    valve = shared / "trivalve11-healthy" / "valve_coarse.json"
    if not valve.exists():
        print(f"skipped: {valve} is not there")
        return SKIPPED
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch) / "tricuspid"
        make = [sys.executable, str(example / "make_scene.py"), coapt]
        subprocess.run([*make, str(valve), str(folder)], check=True)
        absent = subprocess.run([*make, "no_such_valve.json", scratch], capture_output=True, text=True)
        run = subprocess.run([coapt, "solve", str(folder / "scene.json")], capture_output=True, text=True)
        print(run.stdout + run.stderr)
        result = json.loads((folder / "result" / "result.json").read_text(encoding="utf-8"))
    distance = result["distance_to_reference"]
    found = distance["registration"]
    rules = {
        "an absent valve is named": absent.returncode == 2 and "no_such_valve.json" in absent.stderr,
        "converged": run.returncode == 0 and result["converged"],
        "the angle is found": abs(found["angle_deg"] - 30) < 0.5,
        "it was far": found["to_reference_before"]["mean_mm"] > 3,
        "mean distance as in the valve's own frame": 0.05 < distance["mean_mm"] < 0.12,
        "so for 95 %": distance["p95_mm"] < 0.42,
        "the terminal says it": "reference registered" in run.stdout,
    }
    broken = [rule for rule, holds in rules.items() if not holds]
    for rule in broken:
        print(f"broken: {rule}")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
