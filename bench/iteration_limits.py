#!/usr/bin/env python3
"""What the iterations of valves are spent on: rough valves solved as written and with one cause left out at a time.

    bench/iteration_limits.py [path of coapt] [--seeds N] [--triangles N] [--rows ROWS.csv] [--figure OUT.svg]

`coapt generate mitral|tricuspid --rough SEED` for the seeds 1 to N (default 20) with --triangles (default 900), on one
mesh each, so that all iterations count. Left out: contact; the stiffening of leaflets (the isotropic linear law, 1 MPa)
and of chords (the linear law, 20 MPa); the follower direction of the pressure (`frozen`); all of these; and each of them
without the damped path. Prints quartiles of iterations and factorisations of those that converged as a Markdown table.
--figure: the share of valves solved within a number of iterations, a curve for each variant. --rows: goes on where the
file ends, as bench/rough_valves.py does.
"""
import argparse
import csv
import pathlib
import re
import statistics
import tempfile

from real_valves import run
from runs import print_header, solved

COLUMNS = ["kind", "seed", "variant", "status", "iterations", "factorisations", "cpu_s"]
CONTACT = r',\s*\{ "type": "contact_barrier"[^}]*\}'
LEAFLET = r'\{ "type": "cst_\w+", ("name": "[^"]*", )("region": "[^"]*", )?[^}]*?("thickness": "[^"]*")[^}]*\}'
CHORD = r'\{ "type": "cable_?\w*", ([^}]*?"materials": \[[^\]]*\])[^}]*\}'


def without_contact(scene: str) -> str:
    return re.sub(CONTACT, "", scene)


def with_linear_laws(scene: str) -> str:
    leaflets = re.sub(LEAFLET, r'{ "type": "cst_tension_field", \1\2"young": "1 MPa", "poisson": 0.45, \3 }', scene)
    return re.sub(CHORD, r'{ "type": "cable", \1, "young": "20 MPa" }', leaflets)


def with_frozen_pressure(scene: str) -> str:
    return scene.replace('"model": "follower"', '"model": "frozen"')


def with_none(scene: str) -> str:
    return without_contact(with_linear_laws(with_frozen_pressure(scene)))


VARIANTS = {"as written": (str, False), "linear laws": (with_linear_laws, False), "no contact": (without_contact, False),
            "frozen pressure": (with_frozen_pressure, False), "none of them": (with_none, False),
            "at once": (str, True), "at once, linear laws": (with_linear_laws, True),
            "at once, no contact": (without_contact, True), "at once, none of them": (with_none, True)}


def measured(coapt: str, folder: pathlib.Path, variant: str) -> list:
    change, at_once = VARIANTS[variant]
    scene = folder / "variant.json"
    text = (folder / "scene.json").read_text(encoding="utf-8")
    scene.write_text(change(text), encoding="utf-8")
    if change is not str and scene.read_text(encoding="utf-8") == text:
        raise SystemExit(f"{folder / 'scene.json'}: {variant}: nothing to leave out was found")
    result = solved(coapt, scene, "--no-report", "--max-seconds", "300", *(["--damped-steps", "0"] if at_once else []))
    return [result["status"], result["iterations"], result["evaluations"]["factorisations"],
            round(result["time"]["cpu_s"], 3)]


def rows_of(arguments: argparse.Namespace, file: pathlib.Path) -> list[dict]:
    """Solves what the file does not have yet, and gives all of it."""
    done = list(csv.DictReader(file.read_text().splitlines())) if file.exists() else []
    known = {(row["kind"], row["seed"], row["variant"]) for row in done}
    with file.open("a", newline="") as out, tempfile.TemporaryDirectory() as temporary:
        writer = csv.writer(out, lineterminator="\n")
        if not done:
            writer.writerow(COLUMNS)
        folder = pathlib.Path(temporary) / "valve"
        for seed in range(1, arguments.seeds + 1):
            for kind in ("mitral", "tricuspid"):
                missing = [name for name in VARIANTS if (kind, str(seed), name) not in known]
                if missing:
                    run(arguments.coapt, "generate", kind, "--rough", str(seed), "--triangles", str(arguments.triangles),
                        "-o", str(folder))
                for name in missing:
                    writer.writerow([kind, seed, name, *measured(arguments.coapt, folder, name)])
                    out.flush()
    return list(csv.DictReader(file.read_text().splitlines()))


def numbers(rows: list[dict], variant: str, column: str) -> list[float]:
    return sorted(float(row[column]) for row in rows if row["variant"] == variant and row["status"] == "converged")


def quartiles(values: list[float]) -> str:
    if len(values) < 2:
        return ""
    return ", ".join(f"{value:.3g}" for value in statistics.quantiles(values, n=4, method="inclusive"))


def draw(rows: list[dict], out: pathlib.Path) -> None:
    import matplotlib
    matplotlib.use("svg")
    from matplotlib import pyplot
    matplotlib.rcParams["svg.hashsalt"] = "coapt"  # the same figure gives the same bytes
    figure, axes = pyplot.subplots(figsize=(7.2, 4.6))
    colours = {}
    for name in VARIANTS:
        cause = name.removeprefix("at once, ").replace("at once", "as written")
        colour = colours.setdefault(cause, f"C{len(colours)}")
        found = numbers(rows, name, "iterations")
        all_valves = sum(row["variant"] == name for row in rows)
        axes.step(found, [(k + 1) / all_valves for k in range(len(found))], where="post", color=colour, label=name,
                  linestyle="--" if name.startswith("at once") else "-", linewidth=1.2)
    axes.axvline(60, color="grey", linewidth=0.8)
    axes.set(xscale="log", xlabel="iterations", ylabel="share of valves solved", ylim=(0, 1.02),
             title="Rough valves, with one cause of iterations left out")
    axes.grid(True, which="major", linewidth=0.3)
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(out, metadata={"Date": None})


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--triangles", type=int, default=900)
    parser.add_argument("--rows", type=pathlib.Path)
    parser.add_argument("--figure", type=pathlib.Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        rows = rows_of(arguments, arguments.rows or pathlib.Path(temporary) / "rows.csv")
    print_header("left out", "converged", "iterations", "within 60", "factorisations", "CPU s")
    for name in VARIANTS:
        found = numbers(rows, name, "iterations")
        all_valves = sum(row["variant"] == name for row in rows)
        cells = [name, f"{len(found)} of {all_valves}", quartiles(found), str(sum(count <= 60 for count in found)),
                 quartiles(numbers(rows, name, "factorisations")), quartiles(numbers(rows, name, "cpu_s"))]
        print("| " + " | ".join(cells) + " |")
    if arguments.figure:
        draw(rows, arguments.figure)


if __name__ == "__main__":
    main()
