#!/usr/bin/env python3
"""The models of published papers with their own numbers, and what comes out beside what they print.

    bench/papers.py [path of coapt] [--paper NAME ...] [--largest TRIANGLES] [--max-seconds S] [--machine NAME]

Generates the mean mitral valve with `--model`, solves it by static and dynamic methods and by the paper's own, and prints
a Markdown table for each table of docs/papers. With --machine (a row of bench/results/machines.csv) the tables are kept
in bench/results/papers/PAPER, from which bench/tables.py writes the pages. The papers' scans are not published: the valve
is the generator's, so errors against their images have no counterpart, and what is compared is what does not need them.
"""
import argparse
import csv
import datetime
import io
import json
import math
import pathlib
import subprocess
import sys
import tempfile
from typing import Iterator

RESULTS = pathlib.Path(__file__).resolve().parent / "results/papers"
Table = tuple[str, list[list[str]]]  # name, rows with the header first
SIZES = {630: "x1", 2500: "x4", 10000: "x16"}


class Bench:
    """Scenes of one model in a folder of their own, and their solves."""

    def __init__(self, options: argparse.Namespace, model: str, folder: pathlib.Path):
        self.options, self.model, self.folder = options, model, folder

    def scene(self, triangles: int, *arguments: str) -> dict:
        """The generated scene; its files lie in the folder."""
        subprocess.run([self.options.coapt, "generate", "mitral", "--preset", "benchmark", "--model", self.model, "--triangles", str(triangles),
                        *arguments, "-o", str(self.folder)], check=True, stdout=subprocess.DEVNULL)
        text = (self.folder / "scene.json").read_text()
        return json.loads("\n".join(line.split("//")[0] for line in text.splitlines()))

    def solve(self, scene: dict, name: str, max_seconds: float | None = None) -> dict:
        """result.json, with the vertices of the closed shape as `x`."""
        path, out = self.folder / f"{name}.json", self.folder / name
        path.write_text(json.dumps(scene))
        run = subprocess.run([self.options.coapt, "solve", str(path), "-o", str(out), "--no-report", "--max-seconds",
                              str(max_seconds or self.options.max_seconds)], capture_output=True, text=True, check=False)
        if not (out / "result.json").exists():
            raise SystemExit(f"{self.model}, {name}: {run.stderr}")
        result = json.loads((out / "result.json").read_text())
        lines = (out / "closed.obj").read_text().splitlines()
        result["x"] = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
        result["folder"] = out
        return result


def apart(a: list, b: list) -> tuple[float, float]:
    """Mean and greatest distance of vertices of one mesh in two shapes [mm]."""
    distances = [math.dist(p, q) for p, q in zip(a, b)]
    return sum(distances) / len(distances), max(distances)


def distance_to(bench: Bench, scene: dict, name: str, closed: pathlib.Path) -> tuple[float, float]:
    """Of a solve's vertices to another closed surface: mean and greatest [mm]."""
    found = bench.solve(scene | {"reference": {"closed_surface": str(closed)}}, name)["distance_to_reference"]["to_reference"]
    return found["mean_mm"], found["max_mm"]


def solver(keys: dict) -> dict:
    return {"tolerance": 1e-8} | keys


def path_of(keys: dict) -> dict:
    return solver(keys) | {"continuation": {"damped_steps": 20}}


def without_contact(scene: dict) -> dict:
    return scene | {"terms": [term for term in scene["terms"] if not term["type"].startswith("contact")]}


def row(result: dict, *cells: str) -> list[str]:
    """What every table says of a solve."""
    metrics = result["metrics"]
    return [*cells, result["status"].replace("_", " "), f"{result['residual']:.0e}", str(result["iterations"]),
            str(metrics["intersections"]), f"{metrics['orifice_area_mm2']:.1f}", f"{result['time']['cpu_s']:.3g}"]


COLUMNS = ["status", "residual", "steps", "intersections", "orifice mm²", "CPU s"]


def mesh_table(options, folder, model: str, source: list[list[str]], own: dict) -> list[list[str]]:
    """The closure at three sizes: the source's rows, then newton, dynamic and the source's own method."""
    bench = Bench(options, model, folder)
    rows = [["mesh", "triangles", "method", *COLUMNS], *source]
    for triangles, mesh in SIZES.items():
        if triangles > options.largest:
            continue
        scene = bench.scene(triangles)
        for method in ("newton", "dynamic"):
            result = bench.solve(scene | {"solver": path_of({"type": method})}, f"{mesh}-{method}")
            rows.append(row(result, mesh, str(result["mesh"]["triangles"]), f"`{method}`, barrier"))
            print(" | ".join(rows[-1]), file=sys.stderr, flush=True)
        result = bench.solve(without_contact(scene) | {"solver": solver({"type": "dynamic", "dynamics": own})},
                             f"{mesh}-own", options.own_seconds)
        rows.append(row(result, mesh, str(result["mesh"]["triangles"]), "the paper's"))
        print(" | ".join(rows[-1]), file=sys.stderr, flush=True)
    return rows


# --- Hammer et al. 2008 ----------------------------------------------------------------------------------

SENSITIVITIES = [("young_pre", "100 kPa", "110 kPa", 10, "mm/kPa", "-0.00349"),
                 ("young_post", "6 MPa", "6.6 MPa", 600, "mm/kPa", "2.13e-07"),
                 ("transition_strain", 0.25, 0.275, 2.5, "mm/%", "-0.0221")]


def hammer_2008_sensitivities(options, folder) -> list[list[str]]:
    """How far the closed shape moves for a change of a tenth: the source has the change of its error by an image."""
    bench = Bench(options, "hammer-2008", folder)
    scene = bench.scene(630)
    base = bench.solve(scene, "base")
    rows = [["parameter", "unit", "Hammer et al. 2008: change of the mean error", "Coapt: mean move of the vertices",
             "Coapt: greatest move mm", "status"]]
    for key, _, changed, step, unit, paper in SENSITIVITIES:
        other = json.loads(json.dumps(scene))
        for term in other["terms"]:
            if term["type"] == "spring":
                term[key] = changed
        result = bench.solve(other, key)
        mean, most = apart(base["x"], result["x"])
        rows.append([f"`{key}`", unit, paper, f"{mean / step:.2e}", f"{most:.2f}", result["status"]])
    return rows


def hammer_2008(options, folder) -> Iterator[Table]:
    own = {"integration": "backward_differences", "linear_solver": "conjugate_gradients", "collisions": "inelastic"}
    source = [["x1", "631", "Hammer et al. 2008", "closed completely", "", "4000", "", "", "300"],
              ["", "419", "Hammer et al. 2008", "closed completely", "", "4000", "", "", "300"]]
    yield "sensitivities", hammer_2008_sensitivities(options, folder)
    yield "meshes", mesh_table(options, folder, "hammer-2008", source, own)


# --- Hammer et al. 2011 ----------------------------------------------------------------------------------

def hammer_2011_sizes(options, folder) -> list[list[str]]:
    """How far the closed shapes of coarser meshes are from that of the finest."""
    bench = Bench(options, "hammer-2011", folder)
    sizes = [size for size in SIZES if size <= options.largest]
    finest = bench.solve(bench.scene(sizes[-1]), "finest")
    closed = bench.folder / "finest.obj"
    closed.write_bytes((finest["folder"] / "closed.obj").read_bytes())
    paper = {"x1": "0.8, 2.5", "x4": "0.9, 2.9", "x16": "0.9, 2.7"}
    rows = [["mesh", "Hammer et al. 2011: mean, greatest error against the image mm",
             f"Coapt: mean, greatest distance from {SIZES[sizes[-1]]} mm"]]
    for size in sizes[:-1]:
        mean, most = distance_to(bench, bench.scene(size), f"size-{size}", closed)
        rows.append([SIZES[size], paper[SIZES[size]], f"{mean:.2f}, {most:.1f}"])
    return rows + [[SIZES[sizes[-1]], paper[SIZES[sizes[-1]]], "0"]]


def hammer_2011_chords(options, folder) -> list[list[str]]:
    """What the closed shape owes to secondary chords and to the length of all chords."""
    bench = Bench(options, "hammer-2011", folder)
    scene = bench.scene(630)
    base = bench.solve(scene, "base")

    def changed(name: str, keys: dict) -> dict:
        terms = [term | keys if term["type"] == "cable" else term for term in scene["terms"]]
        return bench.solve(scene | {"terms": terms}, name)

    primary = changed("primary", {"materials": ["primary"]})
    network = json.loads((bench.folder / "valve.json").read_text())
    for chord in network["chords"]:
        chord["rest_length"] *= 0.95
    (bench.folder / "short_chords.json").write_text(json.dumps(network))
    short = changed("short", {"network": "short_chords.json"})
    (mean, most), (mean_short, most_short) = apart(base["x"], primary["x"]), apart(base["x"], short["x"])
    lift = [f"{r['metrics']['prolapse_height_mm']:.1f}" for r in (base, primary)]
    return [["change", "Hammer et al. 2011", "Coapt", "status"],
            ["primary chords alone", "mean error 0.8 to 1.8-2.0 mm, greatest 2.4-3.0 to 6.4-7.4 mm",
             f"the shape moves by {mean:.2f} mm in the mean, {most:.1f} mm at most; prolapse {lift[0]} to {lift[1]} mm",
             primary["status"]],
            ["rest length of chords", "about 8 mm of mean error for 100 %",
             f"5 % shorter: moves by {mean_short:.2f} mm in the mean, {mean_short / 0.05:.1f} mm for 100 %; "
             f"{most_short:.1f} mm at most", short["status"]]]


def hammer_2011(options, folder) -> Iterator[Table]:
    own = {"integration": "semi_implicit_euler", "collisions": "balanced"}
    times = [("x1", "655", "21.4"), ("x1", "621", "20.0"), ("x1", "624", "24.8"), ("x4", "2496", "103"),
             ("x16", "9984", "1240")]
    source = [[mesh, count, "Hammer et al. 2011", "closed", "", "", "", "", cpu] for mesh, count, cpu in times]
    yield "chords", hammer_2011_chords(options, folder)
    yield "meshes", mesh_table(options, folder, "hammer-2011", source, own)
    yield "sizes", hammer_2011_sizes(options, folder)


# --- Burlina et al. 2010 ---------------------------------------------------------------------------------

SOLVERS = {"bfgs": {}, "lbfgs": {}, "newton": {}, "dynamic": {}, "newton, damped path": {"damped": True}}


def burlina_variants(scene: dict) -> dict[str, dict]:
    """The literal model, and what a tension field and a barrier change of it."""
    field = [term | {"type": "cst_tension_field"} if term["type"] == "cst_stvk" else term for term in scene["terms"]]
    field.insert(1, {"type": "bending"})
    barrier = lambda terms: [{"type": "contact_barrier"} if t["type"] == "contact_facet" else t for t in terms]
    return {"as printed": scene, "tension field": scene | {"terms": field},
            "barrier": scene | {"terms": barrier(scene["terms"])},
            "both": scene | {"terms": barrier(field)}}


def burlina_orifice(bench: Bench, scene: dict) -> list[list[str]]:
    """What leaves the orifice open: the parts of the model exchanged one after the other, by newton."""
    pressure = {"type": "load_pressure", "value": "120 mmHg", "model": "follower", "side": "front"}
    pressed = [pressure if term["type"] == "load_field" else term for term in scene["terms"]]
    parts = {"as printed": scene["terms"], "a pressure in the place of the field": pressed,
             "this, and a tension field with bending": burlina_variants(scene | {"terms": pressed})["tension field"]["terms"],
             "this, and the barrier": burlina_variants(scene | {"terms": pressed})["both"]["terms"]}
    rows = [["model", *COLUMNS]]
    for name, terms in parts.items():
        keys = {"type": "newton", "tolerance": 1e-6, "max_iterations": 20000}
        result = bench.solve(scene | {"terms": terms, "solver": keys}, name.replace(" ", "-").replace(",", ""))
        rows.append(row(result, name))
    return rows


def burlina_2010(options, folder) -> Iterator[Table]:
    bench = Bench(options, "burlina-2010", folder)
    scene = bench.scene(630)
    rows = [["model", "solver", "status", "residual", "equilibrium", "energy mJ", "steps", "intersections", "orifice mm²",
             "from the first, mean, greatest mm", "CPU s"]]
    for variant, varied in burlina_variants(scene).items():
        first = None
        for name, keys in SOLVERS.items():
            keys = {"type": name.split(",")[0], "tolerance": 1e-6, "max_iterations": 20000}
            if "damped" in name:
                keys["continuation"] = {"damped_steps": 20}
            result = bench.solve(varied | {"solver": keys}, f"{variant}-{name}".replace(" ", "-").replace(",", ""))
            first = first or result["x"]
            mean, most = apart(first, result["x"])
            rows.append([variant, f"`{name}`" if "," not in name else name, result["status"].replace("_", " "),
                         f"{result['residual']:.0e}", result["certificate"]["stability"].replace("_", " "),
                         f"{result['energy_mj']:.3f}", str(result["iterations"]), str(result["metrics"]["intersections"]),
                         f"{result['metrics']['orifice_area_mm2']:.1f}", f"{mean:.2f}, {most:.1f}",
                         f"{result['time']['cpu_s']:.3g}"])
    yield "minima", rows
    yield "orifice", burlina_orifice(bench, scene)


# --- Toma et al. 2016 ------------------------------------------------------------------------------------

PRINTED = {"splay": 0, "splay_out_of_plane": 0, "second_population": 0}  # what the numbers of section 2.5 leave
# Mesh taken in another state than that of rest: section 3.1, areas of the anterior leaflet against the valve in water.
UNFIXED, FIXED = (1 - 0.173) ** -0.5, (1 + 0.048) ** -0.5


def toma_variants(scene: dict) -> dict[str, dict]:
    """The model, what it has beyond the printed numbers exchanged one by one, and meshes as of the paper's two scans."""
    terms = scene["terms"]
    marginal = next(term for term in terms if term.get("name") == "primary")
    leaflets = lambda keys, of=terms: [term | keys if term["type"] == "cst_crimped_fibre" else term for term in of]
    scaled = lambda factor: leaflets({"rest_scale_fibre": factor, "rest_scale_cross": factor})
    return {"numbers as printed: one population, not dispersed": leaflets(PRINTED),
            "dispersed in the plane": leaflets(PRINTED | {"splay": 0.5}),
            "and in space": leaflets({"second_population": 0}),
            "two populations, not dispersed": leaflets({"splay": 0, "splay_out_of_plane": 0}),
            "the model: two populations dispersed in space": terms,
            "strut chords as the marginal ones": [term | {"crimp_ratio": marginal["crimp_ratio"]} if term.get("name") == "strut" else term
                                                  for term in terms],
            "active stress of 100 kPa": leaflets({"active_stress": "100 kPa"}),
            "failure 0.5 beyond the yield": [term | {"failure": 0.5} if "crimped" in term["type"] else term for term in terms],
            "rest shape of an unfixed scan (area -17.3 %)": scaled(UNFIXED),
            "rest shape of a fixed scan (area +4.8 %)": scaled(FIXED)}


def toma_row(name: str, result: dict) -> list[str]:
    metrics = result["metrics"]
    criteria = {entry["name"]: entry for entry in result["healthy_closure"]}
    healthy = [f"{criteria[key]['value']:.2f}" + ("" if criteria[key]["met"] else " (no)")
               for key in ("anterior_share", "coaptation_height_mm", "regurgitant_volume_ml")]
    beyond = f"{metrics['yielded_facets']}, {metrics['yielded_chords']}"
    return [name, result["status"], f"{result['residual']:.0e}", str(metrics["intersections"]), *healthy,
            f"{metrics['prolapse_height_mm']:.1f}", f"{metrics['tenting_height_mm']:.1f}", f"{metrics['max_principal_strain']:.2f}",
            beyond, f"{metrics['max_chord_force_n']:.2f}", f"{result['time']['cpu_s']:.3g}"]


def toma_tuning(bench: Bench, scene: dict) -> list[list[str]]:
    """Tuned to the yield of each material, as the paper's 14 regions are: before and after."""
    rows = [["tuned", "reached", "rounds", "greatest strain over that at yield", "facets, chords beyond yield", "orifice mm²",
             "factors on leaflets", "factors on chord sections", "s"],
            ["Toma et al. 2016, 14 regions", "yes", "14", "below 1", "0, 0", "", "", "", ""]]
    path, out = bench.folder / "tuned.json", bench.folder / "tuned"
    path.write_text(json.dumps(scene))
    for name, regions, sections in (("leaflets, 14 regions", "14", []), ("leaflets, 14 regions, and chord sections", "14", ["--chord-sections"])):
        run = subprocess.run([bench.options.coapt, "tune-regions", str(path), "-o", str(out), "--regions", regions, "--max-seconds",
                              str(bench.options.max_seconds), *sections], capture_output=True, text=True, check=False)
        if not (out / "region_tuning.json").exists():
            raise SystemExit(f"{bench.model}, {name}: {run.stderr}")
        found = json.loads((out / "region_tuning.json").read_text())
        before, after = found["before"], found["after"]
        span = lambda values: f"{min(values):.2f} to {max(values):.2f}" if values else ""
        rows.append([name, "yes" if found["reached"] else "no", str(found["rounds"]),
                     f"{before['max_yield_ratio']:.2f} to {after['max_yield_ratio']:.2f}",
                     f"{before['strained_facets']}, {before['strained_chords']} to {after['strained_facets']}, {after['strained_chords']}",
                     f"{before['orifice_area_mm2']:.1f} to {after['orifice_area_mm2']:.1f}",
                     span([region["factor"] for region in found["regions"] if region["tuned"]]),
                     span([chord["area_scale"] for chord in found["chords"]]), f"{found['wall_s']:.3g}"])
    return rows


def toma_2016(options, folder) -> Iterator[Table]:
    bench = Bench(options, "toma-2016", folder)
    scene = bench.scene(630)
    rows = [["model", "status", "residual", "intersections", "anterior share", "coaptation height mm", "regurgitant volume ml",
             "prolapse mm", "tenting mm", "greatest strain", "facets, chords beyond yield", "greatest chord force N", "CPU s"],
            ["Toma et al. 2016, a healthy closure", "", "", "", "2/3", "3 to 5", "below 5", "minimal", "minimal", "", "none", "", ""]]
    for name, terms in toma_variants(scene).items():
        result = bench.solve(scene | {"terms": terms}, "".join(letter if letter.isalnum() else "-" for letter in name))
        rows.append(toma_row(name, result))
        print(" | ".join(rows[-1]), file=sys.stderr, flush=True)
    yield "closure", rows
    yield "tuning", toma_tuning(bench, scene)


PAPERS = {"hammer-2008": hammer_2008, "hammer-2011": hammer_2011, "burlina-2010": burlina_2010, "toma-2016": toma_2016}


def keep(paper: str, name: str, rows: list[list[str]], options: argparse.Namespace) -> None:
    out = io.StringIO()
    out.write(f"# date: {datetime.date.today()}\n# machine: {options.machine}\n"
              f"# command: bench/papers.py --paper {paper}\n")
    if options.note:
        out.write(f"# note: {options.note}\n")
    csv.writer(out, lineterminator="\n").writerows(rows)
    (RESULTS / paper).mkdir(parents=True, exist_ok=True)
    (RESULTS / paper / f"{name}.csv").write_text(out.getvalue(), encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("coapt", nargs="?", default="build/release/bin/coapt")
    parser.add_argument("--paper", nargs="+", choices=PAPERS, default=list(PAPERS))
    parser.add_argument("--largest", type=int, default=10000)
    parser.add_argument("--max-seconds", type=float, default=1200)
    parser.add_argument("--own-seconds", type=float, default=120, help="limit of a paper's own method")
    parser.add_argument("--machine", help="keep the tables, measured on this machine")
    parser.add_argument("--note", help="with --machine: a note below them")
    options = parser.parse_args()
    for paper in options.paper:
        with tempfile.TemporaryDirectory() as name:
            for table, rows in PAPERS[paper](options, pathlib.Path(name)):
                print(f"\n{paper}, {table}\n\n| " + " | ".join(rows[0]) + " |\n|" + "---|" * len(rows[0]))
                print("\n".join("| " + " | ".join(cells) + " |" for cells in rows[1:]), flush=True)
                if options.machine:
                    keep(paper, table, rows, options)


if __name__ == "__main__":
    main()
