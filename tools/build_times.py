"""Prints where the time of a build went, by Ninja's log: the last build of a tree, by room, in seconds of its commands.

    build_times.py BUILD_DIR [--longest COUNT]

Commands run side by side, so that their sum is more than the time from the first to the last. A log that Ninja has rewritten
(it does so when it has grown) has lost the order, and with it what the last build was.
"""
import argparse
import pathlib
import re
import sys


def last_build(log: str) -> list[tuple[int, int, str]]:
    """Start and end in milliseconds, and what was made: the lines after the last at which the clock began anew."""
    steps: list[tuple[int, int, str]] = []
    for line in log.splitlines():
        if line.startswith("#"):
            continue
        start, end, _, output, _ = line.split("\t")
        if steps and int(end) < steps[-1][1]:
            steps = []
        steps.append((int(start), int(end), output))
    # A command with several outputs is one step.
    return list({(start, end): (start, end, output) for start, end, output in reversed(steps)}.values())


def room(output: str) -> tuple[str, str]:
    """The room and the tree of an output, such as (energy, src); what belongs to no room has a row of its own."""
    if re.search(r"\.(gch|pch)$", output) or "_headers.dir/" in output:
        return "precompiled headers", ""
    if output.startswith("bin/") or re.search(r"\.(a|so)$", output):
        return "linking", ""
    parts = pathlib.PurePosixPath(output).parts
    if parts[0] in ("src", "tests") and len(parts) > 2:
        return parts[1], parts[0]
    return parts[0] if parts[0] in ("bench", "bindings") else "other", ""


def table(steps: list[tuple[int, int, str]]) -> str:
    spent: dict[str, dict[str, float]] = {}
    for start, end, output in steps:
        name, tree = room(output)
        row = spent.setdefault(name, {})
        row[tree] = row.get(tree, 0) + (end - start) / 1000
    rows = [f"| {name} | {row.get('src', 0):.0f} | {row.get('tests', 0):.0f} | {sum(row.values()):.0f} |"
            for name, row in sorted(spent.items(), key=lambda entry: -sum(entry[1].values()))]
    return "\n".join(["| room | its sources [s] | its tests [s] | together [s] |", "|---|---|---|---|", *rows])


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("build", type=pathlib.Path, metavar="BUILD_DIR")
    arguments.add_argument("--longest", type=int, default=0, metavar="COUNT", help="name so many commands that took longest")
    given = arguments.parse_args()
    log = given.build / ".ninja_log"
    if not log.is_file():
        print(f"{log} is not there: no build by Ninja", file=sys.stderr)
        return 2
    steps = last_build(log.read_text(encoding="utf-8"))
    if not steps:
        print(f"{log} holds no build", file=sys.stderr)
        return 2
    print(table(steps))
    for start, end, output in sorted(steps, key=lambda step: step[0] - step[1])[:given.longest]:
        print(f"{(end - start) / 1000:6.0f} s  {output}")
    passed = (max(end for _, end, _ in steps) - min(start for start, _, _ in steps)) / 1000
    print(f"\n{len(steps)} commands of {sum(end - start for start, end, _ in steps) / 1000:.0f} s in {passed:.0f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
