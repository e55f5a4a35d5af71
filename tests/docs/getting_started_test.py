"""Runs the commands of docs/getting_started.md as they stand there, in one empty folder and one shell.

    getting_started_test.py COAPT

Only calls of scripts/ are not run, but must be there; the commands take the given program in the place of theirs.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def blocks(text: str) -> list[str]:
    return re.findall(r"^```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def main() -> int:
    coapt = pathlib.Path(sys.argv[1]).resolve()
    page = (ROOT / "docs/getting_started.md").read_text(encoding="utf-8")
    found = blocks(page)
    lines = []
    for line in "".join(found).splitlines():
        script = re.match(r"(scripts/\S+)", line)
        if script and os.access(ROOT / script[1], os.X_OK):
            continue
        lines.append(line.replace("$PWD/build/release/bin", str(coapt.parent)))
    shell = "set -euxo pipefail\n" + "\n".join(lines)
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(["bash", "-c", shell], cwd=folder, capture_output=True, text=True)
        results = sorted(str(p.relative_to(folder)) for p in pathlib.Path(folder).rglob("result.json"))
    print(done.stderr[-6000:] if done.returncode else "\n".join(results))
    if done.returncode != 0:
        return 1
    # A page without commands would pass all the same.
    if len(found) < 8 or len(results) < 4:
        print(f"{len(found)} blocks, {len(results)} results: less than the page promises")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
