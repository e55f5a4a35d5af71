#!/usr/bin/env python3
"""Says in its last lines which tests a run of ctest has skipped, and why.

    ctest --output-junit FILE ...; tools/skipped_tests.py FILE

Tests that want the shared data, which stand beside a checkout as ../shared/data, are counted by themselves: how to get
them is told in docs/testing.md.
"""
import collections
import re
import sys
from xml.etree import ElementTree


def reason(output: str) -> str:
    """What a skipped test's output says of why: what GoogleTest prints below its place, or a line that says so."""
    lines = [line.strip() for line in output.splitlines()]
    for place, line in zip(lines, lines[1:]):
        if place.endswith(": Skipped") and line:
            return line
    told = [line for line in lines if re.search("skip|lack", line, re.IGNORECASE) and not line.startswith("[")]
    return told[-1] if told else "no reason given"


def main() -> None:
    cases = ElementTree.parse(sys.argv[1]).getroot().findall("testcase")
    reasons: dict[str, list[str]] = collections.defaultdict(list)
    for case in cases:
        if case.find("skipped") is not None or case.get("status") == "notrun":
            reasons[reason(case.findtext("system-out") or "")].append(case.get("name") or "")
    for why, names in sorted(reasons.items(), key=lambda item: -len(item[1])):
        others = "" if len(names) <= 3 else f" and {len(names) - 3} others"
        print(f"skipped: {', '.join(names[:3])}{others}: {why}")
    of_data = sum(len(names) for why, names in reasons.items() if "shared" in why or "data not found" in why)
    total = sum(map(len, reasons.values()))
    data = f", {of_data} of them for want of the shared data: docs/testing.md says how to get it" if of_data else ""
    print(f"{len(cases)} tests, {total} skipped{data}")


if __name__ == "__main__":
    main()
