"""The times of a build: the last of the log alone, a command with several outputs once, each under its room."""
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools"))
from build_times import last_build, room, table  # noqa: E402

LOG = """# ninja log v5
0\t9000\t1\tsrc/energy/CMakeFiles/coapt_room_energy.dir/old.cpp.o\ta
10\t2000\t1\tsrc/energy/CMakeFiles/coapt_room_energy.dir/new.cpp.o\tb
20\t3000\t1\tsrc/energy/made.hpp\tc
20\t3000\t1\tsrc/energy/made.cpp\tc
3000\t3500\t1\tbin/test_energy\td
"""


class BuildTimes(unittest.TestCase):
    def test_only_the_last_build_counts(self):
        outputs = [output for _, _, output in last_build(LOG)]
        self.assertNotIn("src/energy/CMakeFiles/coapt_room_energy.dir/old.cpp.o", outputs)

    def test_a_command_with_two_outputs_counts_once(self):
        self.assertEqual(len(last_build(LOG)), 3)

    def test_outputs_stand_under_their_rooms(self):
        self.assertEqual(room("tests/mesh/CMakeFiles/test_mesh.dir/coarsen_test.cpp.o"), ("mesh", "tests"))
        self.assertEqual(room("src/CMakeFiles/coapt_headers.dir/cmake_pch.hxx.gch"), ("precompiled headers", ""))
        self.assertEqual(room("src/energy/libcoapt_energy.a"), ("linking", ""))

    def test_seconds_are_summed(self):
        self.assertIn("| energy | 5 | 0 | 5 |", table(last_build(LOG)))


if __name__ == "__main__":
    unittest.main()
