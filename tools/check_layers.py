"""Fails when a file includes a room further down the data path, or a public header includes more than
Eigen and the standard library.

The rooms, in order: core, mesh, energy, optim, sensitivity, scene, cli.
"""
import pathlib
import re
import sys

ROOMS = ["core", "mesh", "energy", "optim", "sensitivity", "scene", "cli"]
INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]', re.MULTILINE)
ALLOWED_IN_HEADERS = ("Eigen/", "unsupported/Eigen/")


def defects(root: pathlib.Path) -> list[str]:
    found = []
    for path in sorted(root.rglob("*.[ch]pp")):
        here = path.relative_to(root)
        room = here.parts[0]
        for bracket, name in INCLUDE.findall(path.read_text(encoding="utf-8")):
            if bracket == '"':
                target = name.split("/")[0]
                if target not in ROOMS:
                    found.append(f'{here}: include "{name}" from the src root, by room')
                elif ROOMS.index(target) > ROOMS.index(room):
                    found.append(f'{here}: includes "{name}", against the data path')
            elif path.suffix == ".hpp" and ("." in name or "/" in name):
                is_private = "detail" in here.parts or room == "cli"
                if not name.startswith(ALLOWED_IN_HEADERS) and not is_private:
                    found.append(f"{here}: a public header includes <{name}>; keep it in a source file")
    return found


if __name__ == "__main__":
    problems = defects(pathlib.Path(__file__).resolve().parent.parent / "src")
    print("\n".join(problems) if problems else "layers: in order")
    sys.exit(1 if problems else 0)
