#!/usr/bin/env python3
"""Writes the tables of docs/benchmarks.md from the data in bench/results, those of docs/papers from its papers/, and those of
docs/validation/image.md from its image/.

    bench/tables.py                 puts every table of the pages in order; --check only says whether all are
    bench/newton.py ... | bench/tables.py --record newton --machine epyc --command "bench/newton.py ..."
                                    keeps a table that a benchmark prints as bench/results/newton.csv, with today's date

    ... --record solves/newton      a new one in a folder of bench/results; its name, without the folder, is known from then on

A data file begins with lines "# key: value": date (of the measurement), machine (a row of machines.csv), command, or by what
it was made where no command did, and where needed a note; behind them it is a CSV file. A table of the page stands between the lines "<!-- table NAME -->" and
"<!-- end -->"; what stands there is overwritten. Whole numbers from a thousand on get commas.
"""
import argparse
import csv
import datetime
import io
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/benchmarks.md"
RESULTS = ROOT / "bench/results"
PAPERS = ROOT / "docs/papers"
IMAGES = ROOT / "docs/validation/image.md"
MARKED = re.compile(r"^<!-- table (\w+) -->\n.*?^<!-- end -->\n", re.MULTILINE | re.DOTALL)
KEYS = ("date", "machine", "command", "made", "note")
NOT_TABLES = ("image", "papers", "rows")  # folders of bench/results: tables of other pages, and single solves


def parsed(text: str) -> tuple[dict[str, str], list[list[str]]]:
    """The keys at the head of a data file, and its rows with the header first."""
    lines = text.splitlines()
    head = [line for line in lines if line.startswith("# ")]
    about = dict(line[2:].split(": ", 1) for line in head)
    return about, list(csv.reader(lines[len(head):]))


def defects(name: str, about: dict[str, str], rows: list[list[str]], machines: set[str]) -> list[str]:
    found = [f"{name}: no {key}" for key in KEYS[:2] if key not in about]
    if not {"command", "made"} & about.keys():
        found.append(f"{name}: no command, and no word of what it was made by")
    found += [f"{name}: unknown key {key}" for key in about if key not in KEYS]
    if about.get("machine", "any") not in machines | {"any"}:
        found.append(f"{name}: machine {about['machine']} is not in machines.csv")
    if not re.fullmatch(r"20\d\d-\d\d-\d\d", about.get("date", "2000-01-01")):
        found.append(f"{name}: date {about['date']}")
    if len(rows) < 2 or any(len(row) != len(rows[0]) for row in rows):
        found.append(f"{name}: no rows, or rows of different lengths")
    return found


def shown(cell: str) -> str:
    return f"{int(cell):,}" if re.fullmatch(r"[1-9]\d{3,}", cell) else cell


def rendered(about: dict[str, str], rows: list[list[str]]) -> str:
    """The table in Markdown, and below it where, when and by what it was measured."""
    lines = ["| " + " | ".join(rows[0]) + " |", "|" + "---|" * len(rows[0])]
    lines += ["| " + " | ".join(map(shown, row)) + " |" for row in rows[1:]]
    source = f"*{about['date']}" + ("*" if about["machine"] == "any" else f", {about['machine']}*")
    command = f", `{about['command']}`" if "command" in about else f", {about['made']}"
    note = f". {about['note']}" if "note" in about else "."
    return "\n".join(lines) + f"\n\n{source}{command}{note}\n"


def data_files(results: pathlib.Path) -> dict[str, pathlib.Path]:
    """By the names of their tables."""
    return {path.stem: path for path in sorted(results.rglob("*.csv"))
            if path.relative_to(results).parts[0] not in NOT_TABLES}


def page_text(page: str, results: pathlib.Path) -> tuple[str, list[str]]:
    """The page with its tables in order, and what is wrong with the data."""
    known = results / "machines.csv" if (results / "machines.csv").exists() else RESULTS / "machines.csv"
    machines = {row[0] for row in parsed(known.read_text(encoding="utf-8"))[1][1:]}
    tables, found = {}, []
    files = data_files(results)
    for name, path in files.items():
        about, rows = parsed(path.read_text(encoding="utf-8"))
        wrong = defects(name, about, rows, machines)
        found += wrong
        if not wrong:
            tables[name] = rendered(about, rows)
    named = MARKED.findall(page)
    found += [f"{name}: the page has no such table" for name in sorted(tables.keys() - set(named))]
    found += [f"{name}: the page shows it, and there are no data" for name in named if name not in files]

    def table(match: re.Match) -> str:
        body = tables.get(match[1])
        return f"<!-- table {match[1]} -->\n{body}<!-- end -->\n" if body else match[0]

    return MARKED.sub(table, page), found


def in_order(path: pathlib.Path, results: pathlib.Path, only_checks: bool) -> list[str]:
    """Writes a page anew where its data have changed, or says that it should be; what is wrong with the data."""
    if not path.exists():
        return [f"{results.name}: no page {path.relative_to(ROOT)}"]
    page = path.read_text(encoding="utf-8")
    text, found = page_text(page, results)
    if text != page and only_checks:
        found.append(f"{path.relative_to(ROOT)} is not what its data say; bench/tables.py writes it")
    elif text != page:
        path.write_text(text, encoding="utf-8")
    return found


def cells(line: str) -> list[str]:
    texts = [cell.strip() for cell in line.strip().strip("|").split("|")]
    return [text.replace(",", "") if re.fullmatch(r"\d{1,3}(,\d{3})+", text) else text for text in texts]


def recorded(markdown: str, about: dict[str, str]) -> str:
    """A data file of the first table in a Markdown text."""
    table = re.search(r"(?:^\|.*\n)+", markdown + "\n", re.MULTILINE)
    if not table:
        sys.exit("no table in the input")
    lines = [line for line in table[0].splitlines() if not re.fullmatch(r"[| :-]+", line)]
    out = io.StringIO()
    out.write("".join(f"# {key}: {about[key]}\n" for key in KEYS if about.get(key)))
    csv.writer(out, lineterminator="\n").writerows(map(cells, lines))
    return out.getvalue()


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--check", action="store_true", help="write nothing; 1 where the page is out of date")
    arguments.add_argument("--record", metavar="NAME", help="keep the table on the standard input under this name; a new one with its folder")
    for key in KEYS[1:]:
        arguments.add_argument("--" + key, help=f"with --record: {key} of the measurement")
    given = arguments.parse_args()
    if given.record:
        if not (given.command or given.made):
            arguments.error("--record needs --command, or --made where no command made it")
        about = {"date": str(datetime.date.today()), "machine": given.machine or "any",
                 "command": given.command, "made": given.made, "note": given.note}
        path = data_files(RESULTS).get(given.record, RESULTS / f"{given.record}.csv")
        path.write_text(recorded(sys.stdin.read(), about), encoding="utf-8")
        return 0
    found = in_order(PAGE, RESULTS, given.check) + in_order(IMAGES, RESULTS / "image", given.check)
    for data in sorted((RESULTS / "papers").iterdir()):
        found += in_order(PAPERS / f"{data.name}.md", data, given.check)
    print("\n".join(found) if found else "tables: as their data are")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
