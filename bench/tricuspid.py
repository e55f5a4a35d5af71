#!/usr/bin/env python3
"""Closes the published human tricuspid valve, one modelling choice switched at a time, and prints a Markdown table.

    bench/tricuspid.py [path of coapt] [--data FOLDER] [--full] [--models NAME ...]

FOLDER holds trivalve11-healthy. Coarse mesh from `valve_coarse.json`; --full: full mesh from the Abaqus file, about
three minutes a row. --models: these rows alone (default: all on the coarse mesh, FULL_MODELS on the full one). What
`coapt import` writes, residual 1e-8; distances are to the published closed surface: mean of both
directions, 95 % from ours to it and from it to ours, the greatest of both, the mean between vertices of one number.
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


def leave_out_bending(scene: dict) -> None:
    scene["terms"] = [term for term in scene["terms"] if term["type"] != "bending"]


def take_linear_chords(scene: dict) -> None:
    for term in terms_of(scene, "cable_ogden"):
        del term["mu"], term["alpha"]
        term.update(type="cable", young="40 MPa")


ROWS = {
    "as imported": ([], lambda scene: None),
    "bulk modulus as printed": (["--bulk", "stated"], lambda scene: None),
    "membrane resists compression": ([], change("cst_", compression="resisted")),
    "linear membrane 0.05 MPa, linear chords 40 MPa": (["--young", "0.05 MPa", "--chord-young", "40 MPa"], lambda scene: None),
    "linear membrane 0.03 MPa, linear chords 40 MPa": (["--young", "0.03 MPa", "--chord-young", "40 MPa"], lambda scene: None),
    "linear chords 40 MPa, tissue as above": ([], take_linear_chords),
    "no bending": ([], leave_out_bending),
    "bending D = 3e-4 N mm": ([], change("bending", stiffness="3e-4 N*mm")),
    "bending D = 1e-3 N mm": ([], change("bending", stiffness="1e-3 N*mm")),
    "gap 0.15 mm": ([], change("contact_barrier", gap="0.15 mm")),
    "gap 0.6 mm": ([], change("contact_barrier", gap="0.6 mm")),
    "chord onset rounded over 1 %": ([], change("cable_", smoothing=0.01)),
    "chord onset rounded over 5 %": ([], change("cable_", smoothing=0.05))}


FULL_MODELS = ["as imported", "membrane resists compression", "no bending", "bending D = 1e-3 N mm"]


def imported(coapt: str, source: pathlib.Path, folder: pathlib.Path, options: list[str]) -> dict:
    subprocess.run([coapt, "import", str(source), "-o", str(folder), *options], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    text = (folder / "scene.json").read_text()
    return json.loads("\n".join(line.split("//")[0] for line in text.splitlines()))


def at(tree: dict | None, *keys: str) -> float:
    """A number of the result; not a number where it has none."""
    for key in keys:
        tree = (tree or {}).get(key)
    return float("nan") if tree is None else tree


def cells(result: dict) -> dict[str, str]:
    distance, metrics = result.get("distance_to_reference"), result["metrics"]
    growth = metrics["leaflet_area_closed_mm2"] / metrics["leaflet_area_open_mm2"] - 1
    return {
        "status": result["status"],
        "residual": f"{at(result, 'residual'):.0e}",
        "intersections": str(metrics["intersections"]),
        "mean mm": f"{at(distance, 'mean_mm'):.3f}",
        "95 % to it, from it mm": f"{at(distance, 'to_reference', 'p95_mm'):.3f}, "
                                  f"{at(distance, 'from_reference', 'p95_mm'):.3f}",
        "greatest mm": f"{at(distance, 'max_mm'):.2f}",
        "same vertex mm": f"{at(distance, 'same_vertex', 'mean_mm'):.3f}",
        "area growth": f"{100 * growth:.1f} %",
        "orifice mm2": f"{at(metrics, 'orifice_area_mm2'):.2f}",
        "regurgitant mm2": f"{at(metrics, 'regurgitant_area_mm2'):.2f}",
        "chord force N": f"{at(metrics, 'max_chord_force_n'):.3f}",
        "chord strain, greatest and mean": f"{100 * at(metrics, 'max_chord_strain'):.2f}, "
                                           f"{100 * at(metrics, 'mean_chord_strain'):.2f} %",
        "iterations": str(result["iterations"]),
        "CPU s": f"{result['time']['cpu_s']:.1f}"}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--data", type=pathlib.Path, default="../shared/data")
    parser.add_argument("--full", action="store_true")
    parser.add_argument("--models", nargs="+", choices=ROWS, metavar="NAME")
    arguments = parser.parse_args()
    data = arguments.data / "trivalve11-healthy"
    source = data / ("original/Healthy_QuasiStatic.inp" if arguments.full else "valve_coarse.json")
    has_header = False
    for model in arguments.models or (FULL_MODELS if arguments.full else ROWS):
        options, switch = ROWS[model]
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name) / "valve"
            scene = imported(arguments.coapt, source, folder, options)
            switch(scene)
            scene.setdefault("solver", {})["max_seconds"] = "2000 s"
            if arguments.full:  # the Abaqus file holds no closed state
                scene["reference"] = {"closed_surface": str((data / "leaflets_closed_reference.obj").resolve())}
            (folder / "row.json").write_text(json.dumps(scene))
            row = cells(solved(arguments.coapt, folder / "row.json", "--tolerance", "1e-8"))
            row["contact precision"], row["recall"] = (
                f"{share:.2f}" for share in precision_and_recall(folder / "out/closed.vtp", data, arguments.full))
        if not has_header:
            print_header("model", *row)
            has_header = True
        print(f"| {model} | " + " | ".join(row.values()) + " |", flush=True)


if __name__ == "__main__":
    main()
