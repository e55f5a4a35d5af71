#!/usr/bin/env python3
"""Closes the published human tricuspid valve, one modelling choice switched at a time, and prints a Markdown table.

    bench/tricuspid.py [path of coapt] [--data FOLDER] [--full] [--model TEXT]

FOLDER holds trivalve11-healthy. Coarse mesh from `valve_coarse.json`; --full: from the Abaqus file. --model: only rows
whose name holds TEXT; of the full mesh without it the first row alone. What `coapt import --incompressible` writes, residual 1e-8; distances are to the published closed surface.
Precision and recall: vertices in contact, within 0.3 mm or the gap of the row, against those that the data names; of the
coarse mesh it names none, so each vertex counts as the full mesh's in the same place does.
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

from contact_match import precision_and_recall
from runs import print_header, solved


def terms_of(scene: dict, kind: str) -> list[dict]:
    return [term for term in scene["terms"] if term["type"].startswith(kind)]


def change(kind: str, **keys):
    def apply(scene: dict) -> None:
        for term in terms_of(scene, kind):
            term.update(keys)
    return apply


def take_linear_chords(scene: dict) -> None:
    for term in terms_of(scene, "cable_ogden"):
        del term["mu"], term["alpha"]
        term.update(type="cable", young="40 MPa")


ROWS = {
    "as imported, incompressible": (["--incompressible"], lambda scene: None),
    "bulk modulus as printed": ([], lambda scene: None),
    "membrane resists compression": (["--incompressible"], change("cst_", compression="resisted")),
    "linear membrane 0.05 MPa, linear chords 40 MPa": (["--young", "0.05 MPa", "--chord-young", "40 MPa"], lambda scene: None),
    "linear membrane 0.03 MPa, linear chords 40 MPa": (["--young", "0.03 MPa", "--chord-young", "40 MPa"], lambda scene: None),
    "linear chords 40 MPa, tissue as above": (["--incompressible"], take_linear_chords),
    "bending D = 3e-4 N mm": (["--incompressible"], change("bending", stiffness="3e-4 N*mm")),
    "bending D = 1e-3 N mm": (["--incompressible"], change("bending", stiffness="1e-3 N*mm")),
    "gap 0.15 mm": (["--incompressible"], change("contact_barrier", gap="0.15 mm")),
    "gap 0.6 mm": (["--incompressible"], change("contact_barrier", gap="0.6 mm")),
    "chord onset rounded over 1 %": (["--incompressible"], change("cable_", smoothing=0.01)),
    "chord onset rounded over 5 %": (["--incompressible"], change("cable_", smoothing=0.05))}


def imported(coapt: str, source: pathlib.Path, folder: pathlib.Path, options: list[str]) -> dict:
    subprocess.run([coapt, "import", str(source), "-o", str(folder), *options], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    text = (folder / "scene.json").read_text()
    return json.loads("\n".join(line.split("//")[0] for line in text.splitlines()))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--data", type=pathlib.Path, default="../shared/data")
    parser.add_argument("--full", action="store_true")
    parser.add_argument("--model", default="")
    arguments = parser.parse_args()
    data = arguments.data / "trivalve11-healthy"
    source = data / ("original/Healthy_QuasiStatic.inp" if arguments.full else "valve_coarse.json")
    rows = [row for row in ROWS.items() if arguments.model in row[0]]
    if arguments.full and not arguments.model:
        rows = rows[:1]
    print_header("model", "status", "residual", "intersections", "mean mm", "95 % mm", "area growth", "orifice mm2",
                 "contact precision", "recall", "iterations", "CPU s")
    with tempfile.TemporaryDirectory() as name:
        for model, (options, switch) in rows:
            folder = pathlib.Path(name) / "valve"
            scene = imported(arguments.coapt, source, folder, options)
            switch(scene)
            scene.setdefault("solver", {})["max_seconds"] = "2000 s"
            if arguments.full:  # the Abaqus file holds no closed state
                scene["reference"] = {"closed_surface": str((data / "leaflets_closed_reference.obj").resolve())}
            (folder / "row.json").write_text(json.dumps(scene))
            result = solved(arguments.coapt, folder / "row.json", "--tolerance", "1e-8")
            metrics, distance = result["metrics"], result.get("distance_to_reference", {})
            precision, recall = precision_and_recall(folder / "out/closed.vtp", data, arguments.full)
            growth = metrics["leaflet_area_closed_mm2"] / metrics["leaflet_area_open_mm2"] - 1
            print(f"| {model} | {result['status']} | {result['residual']:.0e} | {metrics['intersections']} | "
                  f"{distance.get('mean_mm', float('nan')):.3f} | {distance.get('p95_mm', float('nan')):.3f} | "
                  f"{100 * growth:.1f} % | {metrics['orifice_area_mm2']:.1f} | {precision:.2f} | {recall:.2f} | "
                  f"{result['iterations']} | {result['time']['cpu_s']:.1f} |", flush=True)


if __name__ == "__main__":
    main()
