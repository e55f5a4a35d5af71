"""What the tests of a portable build share: its folder, the limits that it promises, the valve of the quick start."""
import json
import os
import pathlib
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[3]
BUILD, CPACK = (pathlib.Path(path).resolve() for path in sys.argv[1:3])
sys.path[:0] = [str(SOURCE / "tests/package"), str(SOURCE / "bindings/python")]

IS_ROOT = os.geteuid() == 0
NOT_ROOT = "a root that holds nothing else: only root can make it and chroot into it"
NEWEST_GLIBC = "2.35"  # that of Ubuntu 22.04
LIMIT = 15e6  # bytes


def assert_closed(test, result: pathlib.Path) -> None:
    """The valve of the quick start, as README shows it: an equilibrium, closed, and nothing to warn of."""
    report = json.loads(result.read_text())
    test.assertEqual(report["status"], "converged")
    test.assertLess(report["residual"], 1e-8)
    test.assertEqual(report["warnings"], [])
    test.assertLess(report["metrics"]["orifice_area_mm2"], 1)
    test.assertGreater(report["metrics"]["annulus_area_mm2"], 700)
    test.assertEqual(report["metrics"]["intersections"], 0)
