"""Fails when an include of src is against tools/layers.toml: against its table of rooms, of a private header of another
room, or in a circle; when a public header includes more than Eigen and the standard library; when a library that has
a door is included elsewhere; when the table allows
what no file needs; and when a file compares the name of a term's type, or asks for the class of an object, instead of
what stands in the registry (scene/terms/term_types.hpp) or with the term (energy/term_access.hpp).

    check_layers.py [FOLDER]     the repository, or another tree with src and tools/layers.toml in it
"""
import pathlib
import re
import sys
import tomllib

INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]', re.MULTILINE)
PRIVATE = re.compile(r"\bprivate to this (room|folder)\b", re.IGNORECASE)
HEADERS = re.compile(r"\bHEADERS\s+(.*?)(?=SOURCES|\))", re.DOTALL)
TERM_TYPE = re.compile(r'^\s*static constexpr std::string_view kType = "(\w+)"|\{\.name = "(\w+)",\s*\.s(?:tage|ummary)',
                       re.MULTILINE)
COMPARED = re.compile(r'\btype(?:\(\))?\s*[!=]=\s*(?:"(\w+)"|\w+::kType\b)|\w::kType\s*[!=]=|\btype(?:\(\))?\.starts_with\(')
REGISTRY = "scene/terms/"
MOST_CASTS = 3  # dynamic_cast, in all of src
ALLOWED_IN_HEADERS = ("Eigen/", "unsupported/Eigen/")


def room_of(name: str, rooms: list[str] | dict) -> str:
    """The longest of the table that the file lies in; else its first folder."""
    own = [room for room in rooms if name.startswith(room + "/")]
    return max(own, key=len) if own else name.split("/")[0]


def is_private(name: str, text: str) -> bool:
    return "/detail/" in name or bool(PRIVATE.search(text.split("#pragma once")[0]))


def circle(follows: dict[str, list[str]]) -> list[str]:
    """Names each of which is followed by the next, the last by the first; none where there is no circle."""
    finished: set[str] = set()

    def search(name: str, path: list[str]) -> list[str]:
        if name in path:
            return path[path.index(name):]
        if name in finished:
            return []
        for other in follows.get(name, []):
            if found := search(other, [*path, name]):
                return found
        finished.add(name)
        return []

    return next((found for name in sorted(follows) if (found := search(name, []))), [])


def installed(src: pathlib.Path) -> set[str]:
    """The headers that the lists of CMake call so."""
    found = set()
    for path in src.rglob("CMakeLists.txt"):
        for names in HEADERS.findall(path.read_text(encoding="utf-8")):
            found |= {(path.parent / name).resolve().relative_to(src.resolve()).as_posix() for name in names.split()}
    return found


def third_party_defects(texts: dict[str, str], public: set[str]) -> list[str]:
    found = []
    for name, text in texts.items():
        if name not in public:
            continue
        for bracket, included in INCLUDE.findall(text):
            if bracket == "<" and ("." in included or "/" in included) and not included.startswith(ALLOWED_IN_HEADERS):
                found.append(f"{name}: a public header includes <{included}>; keep it in a source file")
            elif bracket == '"' and included in texts and included not in public:
                found.append(f'{name}: a public header includes "{included}", which is not installed')
    return found


def door_defects(texts: dict[str, str], doors: dict[str, list[str]]) -> list[str]:
    """Includes of a library elsewhere than in the headers that are its door, and doors that are none."""
    found = []
    for library, names in doors.items():
        at = {name for name, text in texts.items()
              for bracket, included in INCLUDE.findall(text) if bracket == "<" and included.startswith(library)}
        found += [f"{name}: includes <{library}...>; include {' or '.join(names)}" for name in sorted(at - set(names))]
        found += [f"tools/layers.toml: {name} is no door to {library}" for name in sorted(set(names) - at)]
    return found


def type_defects(texts: dict[str, str]) -> list[str]:
    """Comparisons of the names of term types outside their registry, and more dynamic casts than there may be."""
    names = {name for text in texts.values() for pair in TERM_TYPE.findall(text) for name in pair if name}
    found = [f"{name}: compares the type of a term, {match[0]}; ask the registry or the term"
             for name, text in texts.items() if not name.startswith(REGISTRY)
             for match in COMPARED.finditer(text) if match[1] is None or match[1] in names]
    casts = {name: text.count("dynamic_cast<") for name, text in texts.items() if "dynamic_cast<" in text}
    if sum(casts.values()) > MOST_CASTS:
        found.append(f"more than {MOST_CASTS} dynamic casts: {', '.join(sorted(casts))}; let the object say what it can")
    return found


def include_defects(includes: dict[str, list[str]], private: set[str], table: dict) -> list[str]:
    """What the table and the sources do not agree on, in both directions."""
    allowed, exceptions = table["may_include"], table["exceptions"]["includes"]
    found, used, excepted = [], set(), set()
    for name, names in includes.items():
        here = room_of(name, allowed)
        for included in names:
            there = room_of(included, allowed)
            if here == there:
                continue
            against = ""
            if there not in allowed.get(here, []):
                against = f"{here} may not include {there}"
            elif included in private:
                against = f"that header is private to {there}"
            used.add((here, there))
            line = f"{name} -> {included}"
            if against and line in exceptions:
                excepted.add(line)
            elif against:
                found.append(f'{name}: includes "{included}"; {against}')
    rooms = {room_of(name, allowed) for name in includes}
    found += [f"src/{room}: has no line in tools/layers.toml" for room in sorted(rooms - set(allowed))]
    found += [f"tools/layers.toml: there is no folder src/{room}" for room in sorted(set(allowed) - rooms)]
    found += [f"tools/layers.toml: no file of {here} includes {there}; take the permission out"
              for here in allowed for there in allowed[here] if here in rooms and (here, there) not in used]
    found += [f"tools/layers.toml: the exception {line} is needed no more; take it out"
              for line in exceptions if line not in excepted]
    return found


def defects(root: pathlib.Path) -> list[str]:
    table = tomllib.loads((root / "tools/layers.toml").read_text(encoding="utf-8"))
    src = root / "src"
    texts = {p.relative_to(src).as_posix(): p.read_text(encoding="utf-8") for p in sorted(src.rglob("*.[ch]pp"))}
    private = {name for name, text in texts.items() if name.endswith(".hpp") and is_private(name, text)}
    includes: dict[str, list[str]] = {}
    found = []
    for name, text in texts.items():
        own = [included for bracket, included in INCLUDE.findall(text) if bracket == '"' or included in texts]
        own = [i for i in own if not (i.endswith(".inc") and (src / i).is_file())]  # tables of numbers
        found += [f'{name}: include "{i}" from the src root, by room' for i in own if i not in texts]
        includes[name] = [i for i in own if i in texts]
    found += include_defects(includes, private, table)
    found += third_party_defects(texts, installed(src))
    found += door_defects(texts, table.get("doors", {}))
    found += type_defects(texts)
    for of, what in ((table["may_include"], "the table allows"), (includes, "files include")):
        if around := circle(of):
            found.append(f"a circle of what {what}: {' -> '.join([*around, around[0]])}")
    return found


if __name__ == "__main__":
    problems = defects(pathlib.Path(sys.argv[1]) if sys.argv[1:] else pathlib.Path(__file__).resolve().parent.parent)
    print("\n".join(problems) if problems else "layers: in order")
    sys.exit(1 if problems else 0)
