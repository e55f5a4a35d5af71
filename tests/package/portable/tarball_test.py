"""The tarball, unpacked at one place, moved to another, and used there.

    tarball_test.py BUILD CPACK

Proved: the command asks for the C library alone, no newer than is promised; in a root of that library and nothing else
(as root) it generates and closes the valve of the quick start; in a root of a compiler, CMake, pkg-config and Eigen
programs are built on the moved library, one by CMake and one by pkg-config, and solve a scene.
"""
import pathlib
import shutil
import tarfile
import tempfile
import unittest

import portable_build
from portable_build import BUILD, CPACK, IS_ROOT, LIMIT, NEWEST_GLIBC, NOT_ROOT, SOURCE

import clean_root
import portability

TOOLS = "g++, cmake, make, dash, pkg-config, libeigen3-dev"
CONSUMER = SOURCE / "tests/package/consumer"
DISC = SOURCE / "examples/02_pressurised_disc"


class Tarball(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory(prefix="coapt-tarball-")
        cls.folder = pathlib.Path(cls.temporary.name)
        clean_root.run(CPACK, "-G", "TXZ", "--config", BUILD / "CPackConfig.cmake", "-B", cls.folder / "packages")
        cls.file, = (cls.folder / "packages").glob("*.tar.xz")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def moved_into(self, place: pathlib.Path) -> None:
        """Unpacks it elsewhere and moves what came of it, so that no path of the first place may be used."""
        first = self.folder / "first"
        with tarfile.open(self.file) as tarball:
            tarball.extractall(first)
        tree, = first.iterdir()
        self.assertEqual(tree.name + ".tar.xz", self.file.name)
        place.parent.mkdir(parents=True, exist_ok=True)
        tree.rename(place)

    def test_is_small_and_named_after_its_system(self):
        self.assertRegex(self.file.name, r"^coapt-\d+\.\d+\.\d+-linux-\w+\.tar\.xz$")
        self.assertLess(self.file.stat().st_size, LIMIT)

    def test_no_file_names_a_place_of_the_build(self):
        place = self.folder / "looked at"
        self.moved_into(place)
        texts = [path for path in place.rglob("*") if path.suffix in (".pc", ".cmake")]
        self.assertGreater(len(texts), 5)
        for path in texts:
            self.assertNotIn(str(SOURCE), path.read_text(), path)
            self.assertNotRegex(path.read_text(), r"/usr/(lib|local|share)", path)

    def test_the_command_asks_for_the_c_library_alone(self):
        place = self.folder / "asked"
        self.moved_into(place)
        self.assertIn("2.", portability.manylinux(place / "bin/coapt", NEWEST_GLIBC).replace("_", "."))
        self.assertIn("Licence: BSD-3-Clause\n", clean_root.run(place / "bin/coapt", "--version") + "\n")
        notices = {path.name for path in (place / "share/doc/coapt/notices").iterdir()}
        self.assertLessEqual({"libeigen3-dev", "libpugixml-dev", "zlib1g-dev", "libcli11-dev"}, notices)

    @unittest.skipUnless(IS_ROOT, NOT_ROOT)
    def test_closes_the_valve_of_the_quick_start_beside_the_c_library(self):
        root = self.folder / "bare"
        clean_root.make(root, "libc6")
        self.moved_into(root / "somewhere else/coapt")
        coapt = "/somewhere else/coapt/bin/coapt"
        clean_root.chroot(root, coapt, "generate", "mitral", "--triangles", "2500", "-o", "/mitral")
        clean_root.chroot(root, coapt, "solve", "/mitral/scene.json")
        portable_build.assert_closed(self, root / "mitral/result/result.json")
        self.assertIn("<canvas", (root / "mitral/result/report.html").read_text())

    @unittest.skipUnless(IS_ROOT, NOT_ROOT)
    def test_serves_programs_through_cmake_and_pkg_config(self):
        root = self.folder / "tools"
        clean_root.make(root, TOOLS, left_out=clean_root.PAPERS)
        self.assertFalse(list(root.rglob("libpugixml*")) + list(root.rglob("libz.a")), "not bare")
        self.moved_into(root / "moved/coapt")
        shutil.copytree(CONSUMER, root / "consumer")
        shutil.copytree(DISC, root / "disc")
        given = {"PATH": "/usr/bin:/bin", "PKG_CONFIG_PATH": "/moved/coapt/lib/pkgconfig"}
        start = lambda *command: clean_root.chroot(root, *command, environment=given)
        start("cmake", "-S", "/consumer", "-B", "/by-cmake", "-DCMAKE_PREFIX_PATH=/moved/coapt", "-DCMAKE_BUILD_TYPE=Release")
        start("cmake", "--build", "/by-cmake")
        self.assertIn("theory", start("/by-cmake/consumer"))
        start("/by-cmake/closed", "/disc/scene.json")
        self.assertIn("theory", start("/by-cmake/consumer_shared"))
        start("/by-cmake/closed_shared", "/disc/scene.json")
        shared = root / "moved/coapt/lib/libcoapt.so"
        self.assertNotRegex(" ".join(portability.needed(shared)), "pugixml|libz")
        flags = start("pkg-config", "--cflags", "--libs", "coapt-shared").split()
        start("c++", "-std=c++20", "-O1", "/consumer/closed.cpp", "-o", "/by-shared", *flags, "-Wl,-rpath,/moved/coapt/lib")
        start("/by-shared", "/disc/scene.json")
        flags = start("pkg-config", "--cflags", "--libs", "coapt-scene").split()
        start("c++", "-std=c++20", "-O1", "/consumer/closed.cpp", "-o", "/by-pkg-config", *flags)
        start("/by-pkg-config", "/disc/scene.json")
        for program in ("by-cmake/closed", "by-pkg-config"):
            self.assertNotRegex(" ".join(portability.needed(root / program)), "pugixml|libz")


if __name__ == "__main__":
    unittest.main(argv=["tarball_test.py"], verbosity=2)
