#!/usr/bin/env python3
"""What a scene pays for features that it does not use: one build with every component against one without.

    bench/frugality.py FULL [LEAN] [--triangles N] [--runs N] [--instructions]

FULL, LEAN: the command, with everything, and built with -DCOAPT_WITH_...=OFF for every component but JSON and CLI11.
Both solve the same scenes by Eigen's factorisation, in turn, on one thread: the generated mitral valve with every
optional feature off, again with chords, bending or follower pressure taken out, and (FULL alone) with one feature put
in. Prints Markdown: CPU time (user, best of N), peak memory, bytes written, counters of result.json.

--instructions counts them with valgrind (cachegrind): no noise, some fifty times as slow. It also says how many of
them were in functions of the feature, by their names in the program, which must be none where the feature is off.
Exit code 1 where a scene without a feature executes any of its functions, or takes more than 2 % more instructions in
FULL than in LEAN beside those of a start: `--version`, in which the libraries of the components are loaded.
"""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from runs import print_header

ALLOWED = 1.02
# Functions that only a scene with the feature has any business in.
FUNCTIONS = {"contact": r"ContactBarrier|ContactFacet|ContactSurface|BarrierCandidates|evaluate_barrier",
             "chords": r"coapt::Cable\b|CableLaw", "bending": r"BendingHinge",
             "follower pressure": r"LoadPressureFollower", "report": r"ShapeRecord|coapt::solve_page|shape_view_html",
             "frames": r"FrameWriter", "modes": r"coapt::smallest_modes\("}


def scene_text(*without: str, contact: bool = False) -> str:
    """The generated scene less some of its terms; pressure is made dead where `follower pressure` is left out."""
    terms = {"leaflets": {"type": "cst_tension_field", "young": "1 MPa", "poisson": 0.45, "thickness": "0.8 mm"},
             "bending": {"type": "bending"},
             "chords": {"type": "cable", "network": "valve.json", "young": "40 MPa"},
             "pressure": {"type": "load_pressure", "value": "120 mmHg", "side": "front",
                          "model": "frozen" if "follower pressure" in without else "follower"}}
    if contact:
        terms["contact"] = {"type": "contact_barrier"}
    supports = [{"nodes": "annulus", "move_to": "annulus_closed"}]
    if "chords" not in without:  # which bring the papillary tips along
        supports.append({"nodes": "papillary", "move_to": "papillary_closed"})
    return json.dumps({
        "mesh": {"file": "leaflets.obj", "sets": "valve.json"},
        "boundary": supports,
        "terms": [term for name, term in terms.items() if name not in without],
        # So many iterates as every scene needs: those that do not converge by then do the same work in both builds.
        "solver": {"type": "newton", "factorisation": "eigen", "tolerance": 1e-8, "max_iterations": 20}})


def user_seconds_and_peak(command: list[str]) -> tuple[float, float]:
    """User CPU time [s] and peak resident memory [MB] of one process."""
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 1):  # 1: not converged
        raise SystemExit(f"{' '.join(command)} failed")
    return used.ru_utime, used.ru_maxrss / 1024


def instructions(command: list[str], folder: pathlib.Path) -> tuple[int, dict[str, int]]:
    """All of them, and those in functions of each feature, without what these call."""
    out = folder / "cachegrind.out"
    subprocess.run(["valgrind", "--tool=cachegrind", "--cache-sim=no", f"--cachegrind-out-file={out}", *command],
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
    total, inside, function = 0, dict.fromkeys(FUNCTIONS, 0), ""
    for line in out.read_text().splitlines():
        if line.startswith("fn="):
            function = line[3:]
        elif line.startswith("summary:"):
            total = int(line.split()[1])
        elif line[:1].isdigit():
            for feature, names in FUNCTIONS.items():
                if re.search(names, function):
                    inside[feature] += int(line.split()[1])
    return total, inside


class Case:
    def __init__(self, name: str, text: str, *options: str, on: tuple[str, ...], lean: bool):
        self.name, self.text, self.options, self.on, self.lean = name, text, options, on, lean


def cases(help_text: str) -> list[Case]:
    always = ("chords", "bending", "follower pressure")
    base, quiet = scene_text(), "--no-report"
    listed = [Case("every option off", base, quiet, on=always, lean=True)]
    for left_out in always:
        listed.append(Case("and no " + left_out, scene_text(left_out), quiet,
                           on=tuple(name for name in always if name != left_out), lean=True))
    listed += [Case("with contact", scene_text(contact=True), quiet, on=(*always, "contact"), lean=False),
               Case("with report.html", base, on=(*always, "report"), lean=False),
               Case("with frames", base, quiet, "--frames", "1", on=(*always, "frames"), lean=False),
               Case("with three modes", base, quiet, "--modes", "3", on=(*always, "modes"), lean=False)]
    if "--checkpoint" in help_text:
        listed.append(Case("with a checkpoint", base, quiet, "--checkpoint", "{folder}/checkpoint", on=always,
                           lean=False))
    return listed


def written(folder: pathlib.Path) -> int:
    return sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())


def measured(programs: dict[str, str], case: Case, scene: pathlib.Path, runs: int, counts: bool) -> dict:
    """By program: best user time, least peak, instructions; and what FULL wrote."""
    scene.write_text(case.text)
    out = scene.parent / "out"
    arguments = ["solve", str(scene), "-o", str(out), *(word.format(folder=scene.parent) for word in case.options)]
    figures: dict = {}
    for name in programs:
        figures[name] = {"cpu": float("inf"), "peak": float("inf")}
    for _ in range(runs):
        for name, program in programs.items():  # in turn, so that a busy moment strikes both
            subprocess.run(["rm", "-rf", str(out)], check=True)
            cpu, peak = user_seconds_and_peak([program, *arguments])
            figures[name]["cpu"] = min(figures[name]["cpu"], cpu)
            figures[name]["peak"] = min(figures[name]["peak"], peak)
            figures[name]["result"] = json.loads((out / "result.json").read_text())
            figures[name]["bytes"] = written(out)
    if counts:
        for name, program in programs.items():
            figures[name]["instructions"], figures[name]["inside"] = instructions([program, *arguments], scene.parent)
    return figures


def pair(figures: dict, key: str, form: str) -> str:
    full = figures["full"][key]
    if "lean" not in figures:
        return form.format(full)
    lean = figures["lean"][key]
    return f"{form.format(full)} / {form.format(lean)} = {full / lean:.3f}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("full")
    parser.add_argument("lean", nargs="?")
    parser.add_argument("--triangles", type=int, default=2500)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--instructions", action="store_true")
    options = parser.parse_args()
    programs, faults = {"full": options.full}, []
    if options.lean:
        programs["lean"] = options.lean
    start = {name: min(user_seconds_and_peak([program, "--version"]) for _ in range(options.runs))
             for name, program in programs.items()}
    print(f"{options.triangles} triangles, {options.runs} runs, {time.strftime('%Y-%m-%d')}, load "
          f"{os.getloadavg()[0]:.1f} on {os.cpu_count()} cores. `--version` takes "
          + ", ".join(f"{cpu:.3f} s and {peak:.1f} MB ({name})" for name, (cpu, peak) in start.items()) + ".\n")
    print_header("scene", "iterates", "contact candidates, searches", "cables", "Hessians, factorisations",
                 "user s, full / lean", "peak MB", "instructions, 1e6", "less those of a start",
                 "of these in functions of features that are on", "of those that are off", "kB written")
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "scene.json"
        starts = {name: instructions([program, "--version"], scene.parent)[0] if options.instructions else 0
                  for name, program in programs.items()}
        subprocess.run([options.full, "generate", "mitral", "--preset", "benchmark", "--triangles", str(options.triangles), "-o", folder],
                       check=True, stdout=subprocess.DEVNULL)
        known = subprocess.run([options.full, "solve", "--help"], capture_output=True, text=True, check=True).stdout
        for case in cases(known):
            asked = programs if case.lean else {"full": options.full}
            figures = measured(asked, case, scene, options.runs, options.instructions)
            result = figures["full"]["result"]
            counters, evaluations = result["counters"], result["evaluations"]
            cells = [case.name, result["iterations"],
                     f"{counters['contact_candidates']}, {counters['contact_searches']}", counters["cable_elements"],
                     f"{evaluations['hessian']}, {evaluations['factorisations']}", pair(figures, "cpu", "{:.3f}"),
                     pair(figures, "peak", "{:.1f}")]
            if "contact" not in case.on and counters["contact_candidates"] + counters["contact_searches"] > 0:
                faults.append(f"{case.name}: counters of contact are not zero")
            if options.instructions:
                for name, figure in figures.items():
                    figure["millions"] = figure["instructions"] / 1e6
                    figure["own"] = (figure["instructions"] - starts[name]) / 1e6
                inside = figures["full"]["inside"]
                off = {name: count for name, count in inside.items() if name not in case.on and count > 0}
                idle = [name for name in case.on if inside[name] == 0]
                cells += [pair(figures, "millions", "{:.1f}"), pair(figures, "own", "{:.1f}"),
                          ", ".join(f"{name} {inside[name] / 1e6:.2f}" for name in case.on), sum(off.values())]
                faults += [f"{case.name}: {count} instructions of {name}" for name, count in off.items()]
                faults += [f"{case.name}: no function of {name} was found: is its pattern right?" for name in idle]
                if "lean" in figures and figures["full"]["own"] > ALLOWED * figures["lean"]["own"]:
                    faults.append(f"{case.name}: more than 2 % more instructions than without the components")
            else:
                cells += ["", "", "", ""]
            cells.append(f"{figures['full']['bytes'] / 1000:.0f}")
            print("| " + " | ".join(str(cell) for cell in cells) + " |", flush=True)
    for fault in faults:
        print("FAILED: " + fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
