#!/usr/bin/env python3
"""Rough valves that close by a cascade close in one shape, whatever their order, their frame and the method.

    one_shape.py COAPT BENCH

BENCH: the folder of bench/one_shape.py, which makes the other forms of each valve.
"""
import pathlib
import subprocess
import sys
import tempfile


def main() -> int:
    coapt, bench = sys.argv[1:3]
    sys.path.insert(0, bench)
    try:
        import numpy  # noqa: F401
    except ImportError:
        print("skipped: numpy is not installed")
        return 77
    from one_shape import row

    failures = 0
    with tempfile.TemporaryDirectory() as temporary:
        root = pathlib.Path(temporary)
        for kind, seed in (("mitral", 12), ("tricuspid", 11)):
            folder = root / kind
            subprocess.run([coapt, "generate", kind, "--rough", str(seed), "--triangles", "3200", "-o", str(folder)],
                           capture_output=True, check=True)
            assert '"cascade": true' in (folder / "scene.json").read_text()
            cells, same, total = row(coapt, folder, root / f"work_{kind}", ["dynamic"], False)
            print(kind, seed, *cells, f"{same} of {total} the first shape")
            failures += cells[0] != "converged" or same < total
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
