"""The published human tricuspid valve (coarse mesh), imported as a scene."""
import pathlib
import subprocess
import sys

SKIPPED = 77


def imported_valve(coapt: str, shared: pathlib.Path, folder: pathlib.Path) -> pathlib.Path:
    """Its scene in this folder, with the materials of the data; ends with code 77, "skipped", where there are no data."""
    source = shared / "trivalve11-healthy" / "valve_coarse.json"
    if not source.exists():
        print(f"skipped: {source} is not there")
        sys.exit(SKIPPED)
    subprocess.run([coapt, "import", str(source), "-o", str(folder)], check=True,
                   stdout=subprocess.DEVNULL)
    return folder / "scene.json"
