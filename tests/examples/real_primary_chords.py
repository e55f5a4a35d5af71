"""The published human tricuspid valve (coarse mesh) with the chords to its free edge only.

    real_primary_chords.py COAPT SHARED_DATA_FOLDER

Exit code 77, "skipped", where the data is not there. Hammer et al. (2011): where the chords to the inner leaflet are left
out, the error against a measured closed valve more than doubles. With all its chords this valve ends 0.100 mm from the
published closed surface (real_tissue.py holds that below 0.13 mm); without the others 0.404 mm were measured.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

from human_valve import imported_valve

WITH_ALL_CHORDS_MM = 0.13


def main() -> int:
    coapt, shared = sys.argv[1], pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        scene = imported_valve(coapt, shared, folder)
        valve = json.loads((folder / "valve.json").read_text())
        ends = {chord["to"]["leaflet"] for chord in valve["chords"] if "leaflet" in chord["to"]}
        cut = {"type": "chord_cut", "ends": sorted(ends - set(valve["free_edge"]))}
        text = scene.read_text().replace('"terms":', f'"interventions": [{json.dumps(cut)}],\n  "terms":', 1)
        scene.write_text(text)
        run = subprocess.run([coapt, "solve", str(scene), "--output", str(folder / "out")], capture_output=True,
                             text=True)
        print(run.stdout, run.stderr)
        result = json.loads((folder / "out" / "result.json").read_text())
    mean = result["distance_to_reference"]["mean_mm"]
    rules = {"converged": result["converged"], "residual at most 1e-8": result["residual"] <= 1e-8,
             "no facets pass through each other": result["metrics"]["intersections"] == 0,
             f"mean distance {mean:.3f} more than twice that with all chords": mean > 2 * WITH_ALL_CHORDS_MM,
             f"mean distance {mean:.3f} below 0.6 mm": mean < 0.6}
    broken = [rule for rule, holds in rules.items() if not holds]
    print("\n".join(broken) or "passed")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
