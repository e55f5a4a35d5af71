"""Fails when a file or a function is longer than CONTRIBUTING.md allows, a room of src has more lines, or a folder of it more
files. What was longer when the limits came stands in
tools/lengths.toml with its length, which may only fall: a greater one fails, and so does one that is not lowered in the
list when the code got shorter, or left there when it came within the limit.

    check_lengths.py [--lower] [FOLDER]     the repository, or another tree with tools/lengths.toml in it
        --lower: write what got shorter into the list

Files of C++ are counted, of bindings those of Python too. Functions of C++ are found by Universal Ctags, and counted from
the line of their name to the closing brace, over all lines.
"""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tomllib

SUFFIXES = {"bindings": {".cpp", ".hpp", ".py", ".pyi"}}  # elsewhere those of C++
LONGEST_FILE = {"src": 400, "bindings": 400, "tests": 500, "bench": 500}
LONGEST_FUNCTION = {"src": 60, "bindings": 60}
LARGEST_ROOM, LARGEST_FOLDER = 8500, 40  # lines; files
ROOT = pathlib.Path(__file__).resolve().parent.parent
HEAD = ("# Files and functions that were longer than CONTRIBUTING.md allows when the limits came, with their lines. None is\n"
        "# added, and no number rises (tools/check_lengths.py); `tools/check_lengths.py --lower` writes what got shorter.\n")


def long_files(root: pathlib.Path) -> dict[str, int]:
    found = {}
    for folder, limit in LONGEST_FILE.items():
        suffixes = SUFFIXES.get(folder, {".cpp", ".hpp"})
        for path in sorted(path for path in (root / folder).rglob("*") if path.suffix in suffixes):
            lines = path.read_text(encoding="utf-8").count("\n")
            if lines > limit:
                found[path.relative_to(root).as_posix()] = lines
    return found


def long_functions(root: pathlib.Path) -> dict[str, int]:
    """By file and name; of overloads, and of functions of the same name in unnamed scopes, the longest."""
    found: dict[str, int] = {}
    for folder, limit in LONGEST_FUNCTION.items():
        if not (root / folder).is_dir():
            continue
        run = subprocess.run(["ctags", "--options=NONE", "--recurse", "--languages=C++", "--langmap=C++:.cpp.hpp",
                              "--kinds-C++=f", "--fields=+ne", "--output-format=json", "-f", "-", folder],
                             cwd=root, capture_output=True, text=True, check=True)
        for line in run.stdout.splitlines():
            tag = json.loads(line)
            lines = tag["end"] - tag["line"] + 1
            if lines > limit:
                scopes = [s for s in tag.get("scope", "").split("::") if s and s != "coapt" and "__anon" not in s]
                name = f"{tag['path']}: {'::'.join([*scopes, tag['name']])}"
                found[name] = max(lines, found.get(name, 0))
    return dict(sorted(found.items()))


def large_rooms(root: pathlib.Path) -> list[str]:
    found, lines = [], {}
    for folder in sorted(path for path in (root / "src").rglob("*") if path.is_dir()):
        files = list(folder.glob("*.[ch]pp"))
        room = folder.relative_to(root / "src").parts[0]
        lines[room] = lines.get(room, 0) + sum(file.read_text(encoding="utf-8").count("\n") for file in files)
        if len(files) > LARGEST_FOLDER:
            found.append(f"{folder.relative_to(root).as_posix()}: {len(files)} files; {LARGEST_FOLDER} are the most of a folder")
    return found + [f"src/{room}: {count} lines; {LARGEST_ROOM} are the most of a room"
                    for room, count in lines.items() if count > LARGEST_ROOM]


def compare(kind: str, present: dict[str, int], listed: dict[str, int]) -> list[str]:
    found = []
    for name in sorted(present.keys() | listed.keys()):
        now, before = present.get(name), listed.get(name)
        if before is None:
            found.append(f"{name}: {now} lines; too long for a {kind} (CONTRIBUTING.md)")
        elif now is None:
            found.append(f"{name}: within the limit, or gone; tools/check_lengths.py --lower takes it off the list")
        elif now > before:
            found.append(f"{name}: {now} lines; it had {before}, and may only get shorter")
        elif now < before:
            found.append(f"{name}: {now} lines, {before} in the list; tools/check_lengths.py --lower writes it there")
    return found


def lowered(present: dict[str, int], listed: dict[str, int]) -> dict[str, int]:
    return {name: min(lines, present[name]) for name, lines in sorted(listed.items()) if name in present}


def table(name: str, lines: dict[str, int]) -> str:
    return f"\n[{name}]\n" + "".join(f'"{key}" = {value}\n' for key, value in lines.items())


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--lower", action="store_true", help="write what got shorter into the list")
    arguments.add_argument("folder", nargs="?", type=pathlib.Path, default=ROOT)
    given = arguments.parse_args()
    if not shutil.which("ctags"):
        sys.exit("check_lengths.py needs ctags: install the package universal-ctags")
    path = given.folder / "tools/lengths.toml"
    listed = tomllib.loads(path.read_text(encoding="utf-8"))
    present = {"files": long_files(given.folder), "functions": long_functions(given.folder)}
    if given.lower:
        listed = {kind: lowered(present[kind], listed[kind]) for kind in present}
        path.write_text(HEAD + "".join(table(kind, listed[kind]) for kind in listed), encoding="utf-8")
    problems = [*compare("file", present["files"], listed["files"]),
                *compare("function", present["functions"], listed["functions"]), *large_rooms(given.folder)]
    print("\n".join(problems) if problems else "lengths: as they should be")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
