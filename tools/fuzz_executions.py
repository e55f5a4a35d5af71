#!/usr/bin/env python3
"""Counts the inputs that libFuzzer has run, and keeps the counts of all runs in one table.

    tools/fuzz_executions.py build/fuzz/Testing/Temporary/LastTest.log build/fuzz/executions.csv

    tools/fuzz_executions.py --record "where it ran"      puts the lines of build/fuzz/executions.csv into docs/reliability.md

The log is that of ctest, the numbers those that a target prints at its end (-print_final_stats=1). A line is added for
each target: date, revision, target, executions. The last line printed is the sum, of this run and of all in the table.
A target that printed no number, as one that crashed at once, is named and is an error: exit code 1.

What is recorded stands in tests/fuzz/executions.csv, of which the page's table is made, with the sum of all; the lines of
build/fuzz/executions.csv are taken away, so that nothing is counted twice.
"""
import csv
import datetime
import io
import pathlib
import re
import subprocess
import sys


def executions(log: str) -> dict[str, int | None]:
    """Inputs run by each target of the log; None where it printed no number."""
    found: dict[str, int | None] = {}
    for part in re.split(r"^\d+/\d+ Testing: ", log, flags=re.MULTILINE)[1:]:
        number = re.search(r"^stat::number_of_executed_units:\s*(\d+)", part, re.MULTILINE)
        found[part.split("\n", 1)[0].strip()] = int(number[1]) if number else None
    return found


def revision() -> str:
    """The commit that is checked out; empty outside of a repository."""
    told = subprocess.run(["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False)
    return told.stdout.strip()


def add_to(table: pathlib.Path, counts: dict[str, int], date: str, commit: str) -> int:
    """Adds a line for each target to the table and returns the sum of all its lines."""
    is_new = not table.exists()
    with table.open("a", newline="", encoding="utf-8") as stream:
        lines = csv.writer(stream, lineterminator="\n")
        if is_new:
            lines.writerow(["date", "revision", "target", "executions"])
        lines.writerows([date, commit, target, count] for target, count in counts.items())
    with table.open(newline="", encoding="utf-8") as stream:
        return sum(int(line["executions"]) for line in csv.DictReader(stream))


ROOT = pathlib.Path(__file__).resolve().parent.parent
RECORD = ROOT / "tests/fuzz/executions.csv"
PAGE = ROOT / "docs/reliability.md"
MARKED = re.compile(r"(<!-- executions -->\n).*?(<!-- end -->\n)", re.DOTALL)
KEYS = ("date", "revision", "where", "target", "executions")


def table(record: str) -> str:
    """Markdown of the recorded lines: those of one date, revision, place and target are one row; the sum below."""
    counts: dict[tuple[str, ...], int] = {}
    for line in csv.DictReader(io.StringIO(record)):
        key = tuple(line[name] for name in KEYS[:-1])
        counts[key] = counts.get(key, 0) + int(line["executions"])
    rows = [f"| {' | '.join((*key[:3], f'`{key[3]}`'))} | {count:,} |" for key, count in counts.items()]
    return "\n".join([f"| {' | '.join(KEYS)} |", "|---|---|---|---|---|", *rows,
                      f"| all | | | | {sum(counts.values()):,} |", ""])


def record(source: pathlib.Path, where: str, kept: pathlib.Path = RECORD, page: pathlib.Path = PAGE) -> None:
    """Moves the lines of a checkout's table to the kept one, and writes that of the page."""
    with source.open(newline="", encoding="utf-8") as stream:
        lines = list(csv.DictReader(stream))
    is_new = not kept.exists()
    with kept.open("a", newline="", encoding="utf-8") as stream:
        out = csv.DictWriter(stream, KEYS, lineterminator="\n")
        if is_new:
            out.writeheader()
        out.writerows(line | {"where": where} for line in lines)
    source.unlink()
    made = table(kept.read_text(encoding="utf-8"))
    page.write_text(MARKED.sub(lambda m: m[1] + made + m[2], page.read_text(encoding="utf-8")), encoding="utf-8")


def main() -> int:
    if sys.argv[1:2] == ["--record"]:
        record(ROOT / "build/fuzz/executions.csv", sys.argv[2])
        return 0
    log, table = map(pathlib.Path, sys.argv[1:3])
    found = executions(log.read_text(encoding="utf-8", errors="replace"))
    counts = {target: count for target, count in found.items() if count is not None}
    for target, count in found.items():
        print(f"{target}: {'no count' if count is None else count}")
    total = add_to(table, counts, datetime.date.today().isoformat(), revision())
    print(f"{sum(counts.values())} executions in this run, {total} in all runs of {table}")
    return 0 if found and len(counts) == len(found) else 1


if __name__ == "__main__":
    sys.exit(main())
