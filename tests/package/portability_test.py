"""What makes a file portable is told from the file itself.

    portability_test.py COMPILER [MODULE]      a module of this build that loads more than the C library, if there is one
"""
import pathlib
import platform
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bindings/python"))
import portability

COMPILER, *MODULES = sys.argv[1:]


class Portability(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory(prefix="coapt-portability-")
        self.addCleanup(self.temporary.cleanup)

    def compiled(self, text: str, *options: str) -> pathlib.Path:
        file = pathlib.Path(self.temporary.name, "module.so")
        source = file.with_suffix(".cpp")
        source.write_text(text)
        subprocess.run([COMPILER, "-shared", "-fPIC", source, "-o", file, *options], check=True)
        return file

    def test_the_newest_symbol_tells_the_release(self):
        file = self.compiled('extern "C" { char *secure_getenv(const char*); int getentropy(void*, unsigned long);'
                             ' int both(void* p) { return getentropy(p, 1) + (secure_getenv("A") != 0); } }', "-nostdlib", "-lc")
        self.assertEqual(portability.glibc(file), (2, 25))  # getentropy came with 2.25, secure_getenv with 2.17
        self.assertEqual(portability.manylinux(file, "2.25"), f"manylinux_2_25_{platform.machine()}")
        with self.assertRaisesRegex(SystemExit, "needs glibc 2.25, newer than 2.24"):
            portability.manylinux(file, "2.24")

    def test_another_library_is_refused(self):
        file = self.compiled("#include <string>\nint length(const char* s) { return std::stoi(std::string(s)); }")
        with self.assertRaisesRegex(SystemExit, r"loads libstdc\+\+\.so\.6.* not portable"):
            portability.manylinux(file, "9.9")
        for module in MODULES:
            with self.assertRaisesRegex(SystemExit, "not portable"):
                portability.manylinux(pathlib.Path(module), "9.9")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
