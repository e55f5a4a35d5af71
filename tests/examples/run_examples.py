"""Solves the scenes of one example, and checks their derivatives and every number of its expected.json.

    run_examples.py COAPT EXAMPLE_FOLDER...
"""
import json
import pathlib
import subprocess
import sys
import tempfile

from measures import Outcome, measured


def scene_defects(coapt: str, scene: pathlib.Path, expected: list[dict]) -> list[str]:
    """What is wrong with one scene or its result; prints the numbers that were compared."""
    check = subprocess.run([coapt, "check", str(scene)], capture_output=True, text=True)
    if check.returncode != 0:
        return [f"{scene}: check: exit code {check.returncode}\n{check.stdout}{check.stderr}"]
    with tempfile.TemporaryDirectory() as scratch:
        run = subprocess.run([coapt, "solve", str(scene), "-o", scratch], capture_output=True, text=True)
        if run.returncode != 0:
            return [f"{scene}: exit code {run.returncode}\n{run.stdout}{run.stderr}"]
        result = json.loads((pathlib.Path(scratch) / "result.json").read_text())
        outcome = Outcome(pathlib.Path(scratch))
        defects = []
        if not result["converged"] or not result["residual"] <= result["solver"]["tolerance"]:
            defects.append(f"{scene}: status {result['status']}, residual {result['residual']}")
        for entry in expected:
            line, holds = verdict(entry, measured(entry, result, outcome))
            print(f"{scene.parent.name}/{scene.name}: {line}")
            if not holds:
                defects.append(f"{scene}: {line}; source: {entry['source']}")
        return defects


def verdict(entry: dict, found: float | None) -> tuple[str, bool]:
    unit = f" {entry['unit']}" if "unit" in entry else ""
    if "value" in entry and entry["value"] is None:
        return f"{entry['what']}: {found}, expected to be left open", found is None
    if "at_most" in entry:
        return f"{entry['what']}: {found:.9g}{unit}, at most {entry['at_most']}", found <= entry["at_most"]
    value, tolerance = entry["value"], entry["tolerance"]
    return (f"{entry['what']}: {found:.9g}{unit}, expected {value} within {tolerance}",
            abs(found - value) <= tolerance)


def example_defects(coapt: str, folder: pathlib.Path) -> list[str]:
    file = folder / "expected.json"
    if not file.exists():
        return [f"{folder}: no expected.json; an example states the numbers that it must give"]
    expected = json.loads(file.read_text())
    defects = [f"{file}: states no number for {scene}" for scene, entries in expected.items() if not entries]
    for scene in sorted(path.name for path in folder.glob("*.json")):
        is_scene = '"terms"' in (folder / scene).read_text()
        if is_scene and scene not in expected:
            defects.append(f"{file}: does not mention {scene}")
    if "scene.json" not in expected:
        defects.append(f"{file}: does not mention scene.json")
    if not (folder / "README.md").exists():
        defects.append(f"{folder}: no README.md")
    for scene, entries in expected.items():
        defects += scene_defects(coapt, folder / scene, entries)
    return defects


def main() -> int:
    if len(sys.argv) < 3:
        print(__doc__, file=sys.stderr)
        return 2
    coapt, folders = sys.argv[1], [pathlib.Path(folder) for folder in sys.argv[2:]]
    defects = [defect for folder in folders for defect in example_defects(coapt, folder)]
    print("\n".join(["FAILED", *defects]) if defects else "passed")
    return 1 if defects else 0


if __name__ == "__main__":
    sys.exit(main())
