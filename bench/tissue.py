#!/usr/bin/env python3
"""Times closures of the generated mitral valve with every membrane law and prints a Markdown table.

    bench/tissue.py [path of coapt] [--runs N] [--largest TRIANGLES]

Follower pressure, barrier contact, residual 1e-8. CPU time of the solve, best of N runs, and its ratio to the linear
tension field's in the same run; iterations beside it, as a softer or stiffer tissue closes on another way.
"""
import pathlib
import subprocess
import tempfile

from runs import parsed_arguments, print_header, solved

SIZES = [625, 2500, 10000]
THICK = '"thickness": "0.8 mm"'
LAWS = {
    "tension field, E 1 MPa": '"cst_tension_field", "young": "1 MPa"',
    "bilinear 0.3, 6 MPa, knee 0.2": '"cst_bilinear", "young_pre": "0.3 MPa", "transition_strain": 0.2',
    "neo-Hookean, mu 0.33 MPa": '"cst_neo_hookean", "shear_modulus": "0.33 MPa"',
    "exponential": '"cst_exponential", "c0": "0.1 MPa", "c1": "0.02 MPa", "c2": 4',
    "exponential, bulk 20 MPa": '"cst_exponential", "c0": "0.1 MPa", "c1": "0.02 MPa", "c2": 4, "bulk": "20 MPa"',
    "orthotropic": '"cst_orthotropic", "fibre_young_pre": "0.5 MPa", "fibre_young_post": "6 MPa", '
                   '"fibre_transition": 0.15, "cross_young_pre": "0.2 MPa", "cross_young_post": "2 MPa", '
                   '"cross_transition": 0.25',
    "May-Newman-Yin, anterior": '"cst_may_newman_yin"',
    "crimped fibre, H0/R0 12": '"cst_crimped_fibre", "crimp_ratio": 12, "radius_ratio": 1.6, "splay": 0.3'}


def with_law(text: str, law: str) -> str:
    start = text.index('{ "type": "cst_tension_field"')
    return text[:start] + '{ "type": ' + law + ", " + THICK + " }" + text[text.index("}", start) + 1:]


def main() -> None:
    arguments = parsed_arguments(__doc__)
    print_header("law", "triangles", "status", "iterations", "CPU s", "of the linear law's")
    with tempfile.TemporaryDirectory() as name:
        for size in (size for size in SIZES if size <= arguments.largest):
            folder = pathlib.Path(name) / str(size)
            subprocess.run([arguments.coapt, "generate", "mitral", "--preset", "benchmark", "--triangles", str(size), "-o", str(folder)],
                           check=True, stdout=subprocess.DEVNULL)
            text, linear = (folder / "scene.json").read_text(), None
            for law, keys in LAWS.items():
                scene = folder / "law.json"
                scene.write_text(with_law(text, keys))
                result = min((solved(arguments.coapt, scene, "--tolerance", "1e-8") for _ in range(arguments.runs)),
                             key=lambda r: r["time"]["cpu_s"])
                seconds = result["time"]["cpu_s"]
                linear = linear or seconds
                print(f"| {law} | {result['mesh']['triangles']} | {result['status']} | {result['iterations']} | "
                      f"{seconds:.2f} | {seconds / linear:.2f} |", flush=True)


if __name__ == "__main__":
    main()
