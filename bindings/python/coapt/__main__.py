"""python3 -m coapt: what the package does from a command line."""
from __future__ import annotations

import argparse
import pathlib
import re
import sys
from collections.abc import Sequence

from ._energy import expression_of
from ._errors import InputError
from ._kernel import kernel_text


def _shapes(entries: Sequence[str]) -> dict[str, tuple[int, ...]]:
    """Of "k", "v:3" and "B:2x2"."""
    shapes = {}
    for entry in (part for some in entries for part in some.split(",")):
        found = re.fullmatch(r"(\w+)(?::([1-9]\d*)(?:x([1-9]\d*))?)?", entry)
        if found is None:
            raise InputError(f"--data: {entry!r} cannot be read; expected NAME, NAME:ROWS or NAME:ROWSxCOLUMNS")
        shapes[found[1]] = (3,) if found[1] == "X" else tuple(int(size) for size in found.groups()[1:] if size)
    return shapes


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python3 -m coapt")
    commands = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    kernel = commands.add_parser(
        "kernel", help="write a C++ kernel of an energy from its formula",
        description="Writes a C++ header with the energy of one element, its gradient and its Hessian, as a kernel of the "
                    "library (docs/python.md).")
    kernel.add_argument("type", help="name of the struct, such as NeoHookeanTriangle")
    kernel.add_argument("expression", help="the energy of one element as of coapt.energy; - reads it from standard input")
    kernel.add_argument("--nodes", type=int, required=True, help="of an element")
    kernel.add_argument("--data", action="append", default=[],
                        help="names of the data, such as k,r or v:3,B:2x2; X for the reference positions")
    kernel.add_argument("--role", default="internal", help="internal, load or contact")
    kernel.add_argument("--output", type=pathlib.Path, help="the file; default: standard output")
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    given = _parser().parse_args(arguments)
    source = sys.stdin.read() if given.expression == "-" else given.expression
    try:
        if given.nodes < 1:
            raise InputError(f"--nodes: is {given.nodes}; expected a number above 0")
        shapes = _shapes(given.data)
        text = kernel_text(expression_of(source, given.nodes, shapes), given.nodes, shapes, given.type, role=given.role,
                           source=source)
        if given.output is None:
            print(text, end="")
        else:
            given.output.write_text(text, encoding="utf-8")
    except (InputError, ImportError, OSError) as error:
        print(f"python3 -m coapt kernel: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
