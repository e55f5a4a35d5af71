"""Runs the commands and the Python blocks that the pages of docs show, on small valves.

    commands_test.py COAPT [PYTHON_MODULE_FOLDER]

A line is run as it stands, but for sizes that would take long (CHEAPER); what needs a file that is not at hand, or takes
minutes, stands in LEFT_OUT with the reason. Exit code 2, bad input, is a defect of the page.
docs/getting_started.md has a test of its own, which runs it as one session.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
COAPT = pathlib.Path(sys.argv[1]).resolve()
PAGES = ["commands.md", "generators.md", "interventions.md", "interrupts.md", "registration.md", "stress.md", "tuning.md"]
VOLUME_PAGES = ["image.md", "segmentation.md"]  # where the build reads volumes

CHEAPER = [(r"--triangles \d+", "--triangles 250"), (r"--levels \d", "--levels 1"), (r"^(coapt tune .*)", r"\1 --max-solves 3"),
           (r"^coapt stress$", "coapt stress --rows S1,S16 --time-limit 5"), (r"--rows S1,S16 SCENE", "--rows S3,S8 SCENE"),
           (r"^coapt stress SCENE$", "coapt stress --rows S8,S10,S20 SCENE"), (r"0\.7mm|0\.5mm", "0.9mm"),
           (r"26\.\.3[46]mm(:6)?", "26..28mm:2"), (r"0\.65,0\.75,0\.85", "0.7"), (r"80\.\.140mmHg", "80..140mmHg:2")]
LEFT_OUT = {r"^coapt bench|--accuracy|^coapt tune-regions": "takes a minute and more; tests/cli has bench_test.py, study_test.py",
            r"valve\.inp|leaflets\.ply": "wants a valve of another program; tests/exchange has them",
            r"--resume": "what it would resume has come to its end; tests/cli/resume_test.py"}
WITHOUT_VOLUMES = {r"\.mrk\.json|\.nrrd|coapt image|coapt phantom": "wants markups or a volume; image.md and segmentation.md are run with those",
                   r"^coapt stress": "stress.md is run with cheaper rows"}
OF_VOLUMES = {r"\.seq\.nrrd|dicom_folder": "wants a series of a scanner or of 3D Slicer; tests/cli/image_test.py makes them"}
LEAST_RUN = 20

# What the Python blocks of a page find, in the order of the page; a reason where a block is left out.
BEFORE = """
import pickle, os, sys, types
import numpy as np
import scipy.optimize, scipy.sparse
import coapt
V, F = coapt_disc()
pressure = {"type": "load_pressure", "value": "0.1 kPa"}
edges = np.unique(np.sort(np.vstack([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1), axis=0).astype(np.int32)
lengths = 0.9 * np.linalg.norm(V[edges[:, 1]] - V[edges[:, 0]], axis=1)
target_V, target_F = V + [0.05, 0.02, 0.1], F
membrane = {"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"}
"""
PYTHON_LEFT_OUT = {"import_valve(": "wants markups; tests/python/import_test.py", "results": "wants several results and matplotlib; tests/python/notebook_test.py",
                   "bounds=...": "has an ellipsis for what the reader chooses; tests/python/optimiser_test.py"}


def lines_of(page: str) -> list[str]:
    """Commands of indented and of fenced blocks, without their comments."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    found = re.findall(r"^    (coapt .*)$", text, re.MULTILINE)
    for block in re.findall(r"^```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        found += [line for line in block.splitlines() if line.startswith("coapt ")]
    return [re.sub(r"\s+#.*", "", line).strip() for line in found]


def reason(page: str, line: str) -> str:
    own = OF_VOLUMES if page in VOLUME_PAGES else {} if page == "stress.md" else WITHOUT_VOLUMES
    return next((why for pattern, why in {**LEFT_OUT, **own}.items() if re.search(pattern, line)), "")


def cheap(line: str) -> str:
    for pattern, instead in CHEAPER:
        line = re.sub(pattern, instead, line)
    return line


def coapt(*words, cwd) -> subprocess.CompletedProcess:
    return subprocess.run([COAPT, *map(str, words)], cwd=cwd, capture_output=True, text=True, timeout=300)


def furnished(folder: pathlib.Path, page: str) -> None:
    """The files that the lines name: a small valve, open and closed, as scene, mesh and valve."""
    made = coapt("generate", "mitral", "--triangles", 200, "--preset", "benchmark", "-o", "out/mitral", cwd=folder)
    assert made.returncode == 0, made.stderr
    assert coapt("solve", "out/mitral/scene.json", cwd=folder).returncode == 0
    for name in ("scene.json", "leaflets.obj", "valve.json"):
        shutil.copy(folder / "out/mitral" / name, folder / name)
    closed = (folder / "out/mitral/result/closed.obj").read_text()
    shutil.copy(folder / "out/mitral/result/closed.vtp", folder / "closed.vtp")
    for name in ("A.obj", "B.obj", "closed.obj", "scan.obj"):
        (folder / name).write_text(closed)
    if page == "interventions.md":
        scene = folder / "scene.json"
        ring = '"interventions": [{"type": "ring", "size": "28 mm", "stiffness": "flexible"}],\n  "terms":'
        scene.write_text(scene.read_text().replace('"terms":', ring, 1))
    os.symlink(ROOT / "examples", folder / "examples")
    os.symlink("scene.json", folder / "SCENE")
    if page in VOLUME_PAGES:
        furnish_volume(folder)


def furnish_volume(folder: pathlib.Path) -> None:
    """An image of the valve, with its annulus and papillary tips as 3D Slicer has them."""
    made = coapt("phantom", "out/mitral/scene.json", "--voxel", "0.7mm", "-o", "phantom", cwd=folder)
    assert made.returncode == 0, made.stderr
    image, ring = folder / "phantom/open/image.nrrd", json.loads((folder / "phantom/open/annulus.mrk.json").read_text())
    for name in ("open.nrrd", "volume.nrrd"):
        shutil.copy(image, folder / name)
    assert coapt("image", "convert", image, "-o", folder / "volume.mha", cwd=folder).returncode == 0
    (folder / "ring.mrk.json").write_text(json.dumps(ring))
    valve = json.loads((folder / "valve.json").read_text())
    markup = ring["markups"][0]
    tips = {**markup, "type": "Fiducial", "controlPoints": [
        {**markup["controlPoints"][0], "id": str(k + 1), "label": f"tip-{k + 1}", "position": point} for k, point in enumerate(valve["papillary"])]}
    (folder / "tips.mrk.json").write_text(json.dumps({**ring, "markups": [tips]}))


def run_page(page: str) -> tuple[int, list[str]]:
    count, defects = 0, []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        furnished(folder, page)
        shell = f"set -u; coapt() {{ '{COAPT}' \"$@\"; }}\n"
        for line in lines_of(page):
            if why := reason(page, line):
                print(f"left out  {page}: {line}\n          {why}")
                continue
            done = subprocess.run(["bash", "-c", shell + cheap(line)], cwd=folder, capture_output=True, text=True, timeout=300)
            count += 1
            print(f"{'ok' if done.returncode in (0, 1, 4) else 'FAILED':9} {page}: {line}")
            if done.returncode not in (0, 1, 4):
                defects.append(f"{page}: {line}\n  {done.stderr.strip()}")
    return count, defects


def run_python(page: str, module: str) -> tuple[int, list[str]]:
    """Every block in one program, in its order."""
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    blocks, parts = re.findall(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL), [BEFORE]
    for block in blocks:
        why = next((why for word, why in PYTHON_LEFT_OUT.items() if word in block), "")
        if why:
            print(f"left out  {page}: {block.splitlines()[0]}\n          {why}")
        else:
            parts.append(f"print({block.splitlines()[0]!r}, flush=True)\n" + block)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        furnished(folder, page)
        os.chdir(folder)
        program = ("import sys\nsys.path.insert(0, " + repr(str(ROOT / "tests/python")) + ")\nfrom meshes import disc\n"
                   "coapt_disc = lambda: disc(5)\n" + "\n".join(parts))
        done = subprocess.run(["/usr/bin/python3", "-B", "-c", program], cwd=folder, capture_output=True, text=True, timeout=300,
                              env={**os.environ, "PYTHONPATH": module, "PYTHONDONTWRITEBYTECODE": "1"})
        os.chdir(ROOT)
    print(done.stdout)
    return len(parts) - 1, [] if done.returncode == 0 else [f"{page}: {done.stderr[-3000:]}"]


def main() -> int:
    count, defects = 0, []
    has_volumes = "needs ITK" not in coapt("image", "info", "none.nrrd", cwd=ROOT).stderr
    for page in [*PAGES, *VOLUME_PAGES] if has_volumes else PAGES:
        found = run_page(page)
        count, defects = count + found[0], defects + found[1]
    if len(sys.argv) > 2:
        blocks, wrong = run_python("python.md", str(pathlib.Path(sys.argv[2]).resolve()))
        defects += wrong if blocks >= 6 else [*wrong, f"python.md: only {blocks} blocks were run"]
    print(f"{count} commands were run")
    if count < LEAST_RUN:
        defects.append(f"only {count} commands were run, which is less than the pages have")
    print("\n".join(defects))
    return 1 if defects else 0


if __name__ == "__main__":
    sys.exit(main())
