"""Writes a scene of the published human tricuspid valve with its closed surface as a scan in another frame.

    make_scene.py COAPT VALVE_JSON FOLDER

COAPT is the command, VALVE_JSON the valve with its meshes beside it (README.md says where it is published), FOLDER is made. The
closed surface becomes FOLDER/scan.obj, turned by 30 degrees and moved by 10 mm, as the frame of a scanner is none of the
model's; the scene asks for registration by the surface.
"""
import math
import pathlib
import re
import subprocess
import sys

AXIS, DEGREES, SHIFT_MM = (1, 2, 3), 30, (6, -5, 6.24)


def rotation(axis: tuple[float, ...], degrees: float) -> list[list[float]]:
    """By Rodrigues' formula, as rows."""
    size = math.sqrt(sum(a * a for a in axis))
    x, y, z = (a / size for a in axis)
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    d = 1 - c
    return [[c + x * x * d, x * y * d - z * s, x * z * d + y * s],
            [y * x * d + z * s, c + y * y * d, y * z * d - x * s],
            [z * x * d - y * s, z * y * d + x * s, c + z * z * d]]


def moved(obj: str) -> str:
    """The text of an OBJ file with its vertices in the frame of the scanner; its faces as they are."""
    turn = rotation(AXIS, DEGREES)
    lines = []
    for line in obj.splitlines():
        if line.startswith("v "):
            point = [float(number) for number in line.split()[1:4]]
            new = [sum(r * p for r, p in zip(row, point)) + s for row, s in zip(turn, SHIFT_MM)]
            line = "v " + " ".join(f"{number:.9g}" for number in new)
        lines.append(line)
    return "\n".join(lines) + "\n"


def main() -> int:
    coapt, valve, folder = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    if not valve.exists():
        print(f"{valve}: is not there; README.md of this example says where the valve is published", file=sys.stderr)
        return 2
    subprocess.run([coapt, "import", str(valve), "-o", str(folder)], check=True)
    (folder / "scan.obj").write_text(moved((folder / "closed_reference.obj").read_text(encoding="utf-8")), encoding="utf-8")
    scene = folder / "scene.json"
    text, count = re.subn(r'"reference": \{[^}]*\}', '"reference": { "closed_surface": "scan.obj", "register": "surface" }',
                          scene.read_text(encoding="utf-8"))
    if count != 1:
        print(f"{scene}: names no closed surface; the valve has none", file=sys.stderr)
        return 2
    scene.write_text(text, encoding="utf-8")
    print(f"written: {scene}, {folder / 'scan.obj'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
