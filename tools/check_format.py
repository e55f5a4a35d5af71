"""Fails when a C++ file is not formatted as .clang-format says, or defines a function-like macro (CONTRIBUTING.md)."""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
MACRO = re.compile(r"^\s*#\s*define\s+\w+\(", re.MULTILINE)


def sources() -> list[pathlib.Path]:
    folders = ["include", "src", "tests", "bench", "bindings"]
    return sorted(p for f in folders for p in (ROOT / f).rglob("*.[ch]pp"))


def defects() -> list[str]:
    found = []
    for path in sources():
        if MACRO.search(path.read_text(encoding="utf-8")):
            found.append(f"{path.relative_to(ROOT)}: function-like macro")
    check = subprocess.run(["clang-format", "--dry-run", "--Werror", *map(str, sources())],
                           capture_output=True, text=True)
    if check.returncode != 0:
        names = sorted(set(re.findall(r"^(\S+?):\d+:\d+: error", check.stderr, re.MULTILINE)))
        found += [f"{pathlib.Path(n).relative_to(ROOT)}: not formatted; run clang-format -i on it" for n in names]
        found += [] if names else [check.stderr]
    return found


if __name__ == "__main__":
    problems = defects()
    print("\n".join(problems) if problems else "format: as it should be")
    sys.exit(1 if problems else 0)
