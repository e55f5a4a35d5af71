"""Fails when a C++ file is not formatted as .clang-format says, or a file or function-like macro breaks
the limits of CONTRIBUTING.md (500 lines a file, no function-like macros)."""
import pathlib
import re
import subprocess
import sys

LONGEST_FILE = 500
ROOT = pathlib.Path(__file__).resolve().parent.parent
MACRO = re.compile(r"^\s*#\s*define\s+\w+\(", re.MULTILINE)


def sources() -> list[pathlib.Path]:
    folders = ["src", "tests", "bench", "bindings"]
    return sorted(p for f in folders for p in (ROOT / f).rglob("*.[ch]pp"))


def defects() -> list[str]:
    found = []
    for path in sources():
        text = path.read_text(encoding="utf-8")
        lines = text.count("\n")
        if lines > LONGEST_FILE:
            found.append(f"{path.relative_to(ROOT)}: {lines} lines; the limit is {LONGEST_FILE}")
        if MACRO.search(text):
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
