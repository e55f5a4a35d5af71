"""Writes docs/constants.md: every heuristic constant of energies, solvers, runs, tuning and registration, and of the meshes that
solving makes and compares; what each means and where it comes from.

    constants.py            writes the page; --check only says whether it is up to date

A constant is a `constexpr` number, or array of numbers, whose name is k and a capital. What it means says the comment behind it, or the one above it,
which also stands for the constants below that have none. Where its value comes from says tools/constants.toml; what is not
there was set by hand. An entry there may be a table with `meaning` and `origin`: its meaning goes before that of the source. A constant without a meaning and an origin without a constant are errors.
"""
import pathlib
import re
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/constants.md"
FOLDERS = ("src/mesh/distance", "src/mesh/remesh", "src/energy", "src/linear", "src/optim", "src/xpbd", "src/sensitivity", "src/registration",
           "src/solve", "src/run", "src/tuning", "src/image")
NUMBER = re.compile(r"^ *(?:static |inline )*constexpr (?:double|float|int|unsigned|size_t|std::size_t|Eigen::Index|std::array) "
                    r"(k[A-Z]\w* *=[^;]*);[ \t]*(?://[ \t]*(.*))?$", re.MULTILINE)
NUMBERS = re.compile(r"\{[\d., e+-]+\}")  # an array of these; one of names is no constant of a method
BY_HAND = "set by hand"
HEAD = """# Constants

Every heuristic constant of energies, solvers, sensitivities, registration, runs and tuning, and of the meshes that solving makes and compares:
numbers that a method needs and no formula gives. Written by `tools/constants.py` from the sources and `tools/constants.toml`; lengths, forces and
stresses are relative to what the meaning names.
*Set by hand* says that no measurement or publication is on record for the value: {by_hand} of {all}.
"""


# Sizes of arrays, counts of nodes and weights of quadrature rules, which are no choice.
STRUCTURAL = {"kNodes", "kSize", "kTerms", "kPerPage", "kVertexWeight", "kEdgeWeight", "kCentroidWeight",
              "mesh/distance/collision_detection.cpp: kFirst"}


def split(declarators: str) -> list[tuple[str, str]]:
    """Names and values of "kA = 1, kB = f(2, 3)"."""
    parts = re.split(r",\s*(?=k[A-Z]\w*\s*=)", " ".join(declarators.split()))
    return [tuple(part.split(" = ", 1)) for part in parts]


def comment_above(lines: list[str], at: int) -> str:
    """The comment that ends on the line before `at`; constants between it and that line do not hide it."""
    while at > 0 and re.match(r" *(static |inline )*constexpr .*;$", lines[at - 1]):
        at -= 1
    end = at
    indent = lines[at][:len(lines[at]) - len(lines[at].lstrip())]
    while at > 0 and lines[at - 1].startswith(indent + "// "):
        at -= 1
    return " ".join(line.strip()[3:] for line in lines[at:end])


def constants(root: pathlib.Path) -> list[tuple[str, str, str, str]]:
    """File, name, value, meaning, in the order of the sources."""
    found = []
    for path in sorted(p for folder in FOLDERS for p in (root / folder).rglob("*.[ch]pp")):
        text = path.read_text(encoding="utf-8")
        lines = text.split("\n")
        for match in NUMBER.finditer(text):
            first = text.count("\n", 0, match.start())
            meaning = (match[2] or comment_above(lines, first)).strip()
            last = text.count("\n", 0, match.end())
            column = lines[last].find("// ")
            for line in lines[last + 1:] if match[2] else []:
                if line.find("// ") != column or line[:column].strip():
                    break
                meaning += " " + line.strip()[3:]
            file, parts = path.relative_to(root / "src").as_posix(), split(match[1])
            each = meaning.split("; ") if meaning.count(";") == len(parts) - 1 else [meaning] * len(parts)
            found += [(file, name, value, of) for (name, value), of in zip(parts, each)
                      if not {name, f"{file}: {name}"} & STRUCTURAL and (value[0] != "{" or NUMBERS.fullmatch(value))]
    return found


Origins = dict[str, dict[str, str | dict[str, str]]]


def with_meanings(found: list[tuple[str, str, str, str]], origins: Origins) -> list[tuple[str, str, str, str]]:
    """The constants with the meanings that tools/constants.toml gives in place of the comments of the sources."""
    def given(file: str, name: str, meaning: str) -> str:
        entry = origins.get(file, {}).get(name)
        return entry.get("meaning", meaning) if isinstance(entry, dict) else meaning
    return [(file, name, value, given(file, name, meaning)) for file, name, value, meaning in found]


def origin(origins: Origins, file: str, name: str) -> str:
    entry = origins.get(file, {}).get(name, BY_HAND)
    return entry.get("origin", BY_HAND) if isinstance(entry, dict) else entry


def page(found: list[tuple[str, str, str, str]], origins: Origins) -> str:
    by_hand = sum(origin(origins, file, name) == BY_HAND for file, name, _, _ in found)
    out = [HEAD.format(by_hand=by_hand, all=len(found))]
    room = file = last = None
    for place, name, value, meaning in found:
        if place.split("/")[0] != room:
            room = place.split("/")[0]
            out.append(f"\n## {room}\n\n| file | constant | value | meaning | origin |\n|---|---|---|---|---|\n")
        shown = f"`{place.split('/', 1)[1]}`" if place != file else ""
        said = "the same comment" if place == file and meaning == last else meaning.replace("|", "\\|")
        file, last = place, meaning
        out.append(f"| {shown} | `{name}` | {value} | {said} | {origin(origins, place, name)} |\n")
    return "".join(out)


def defects(found: list[tuple[str, str, str, str]], origins: Origins) -> list[str]:
    known = {(file, name) for file, name, _, _ in found}
    wrong = [f"src/{file}: {name} has no comment that says what it is" for file, name, _, meaning in found if not meaning]
    return wrong + [f"tools/constants.toml: {file} has no {name}" for file, of in origins.items() for name in of
                    if (file, name) not in known]


def main() -> int:
    origins = tomllib.loads((ROOT / "tools/constants.toml").read_text(encoding="utf-8"))
    found = with_meanings(constants(ROOT), origins)
    wrong = defects(found, origins)
    text = page(found, origins)
    if "--check" not in sys.argv:
        PAGE.write_text(text, encoding="utf-8")
    elif not PAGE.exists() or PAGE.read_text(encoding="utf-8") != text:
        wrong.append("docs/constants.md is not what the sources say; tools/constants.py writes it")
    print("\n".join(wrong) if wrong else f"constants: {len(found)}, each with its meaning")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
