"""The Debian packages of a build tree, installed into an empty root and used there.

    debian_test.py BUILD CPACK CONSUMER.cpp COMPILER

Proved: CPack packs what the build tree holds without building; dpkg itself unpacks and configures the packages in
a fresh root, whose database names what they declare to depend on, so that an unmet dependency is an error; licences
are apart; every library that the command loads belongs to a package that it depends on; the command generates and
solves a valve with no files but those (as root: in a chroot); Python solves a scene in a root of the packages that
python3-coapt depends on and nothing else (as root); a project is compiled by pkg-config alone.
"""
import functools
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

import clean_root
from clean_root import closure, run

BUILD, CPACK, CONSUMER, COMPILER = (pathlib.Path(p) for p in sys.argv[1:5])
IS_ROOT = os.geteuid() == 0
DISC = pathlib.Path(__file__).resolve().parents[2] / "examples/02_pressurised_disc"


@functools.cache
def owner(library: str) -> str:
    """The package of a library; merged /usr has two names for one file."""
    real = os.path.realpath(library)
    for path in (library, real, real.removeprefix("/usr"), library.removeprefix("/usr"), "/usr" + library):
        found = subprocess.run(["dpkg-query", "-S", path], capture_output=True, text=True)
        if found.returncode == 0:
            return found.stdout.split(":")[0]
    raise AssertionError(f"{library} belongs to no package")


def depends(file: pathlib.Path) -> str:
    return run("dpkg-deb", "-f", file, "Depends").strip()


def install(root: pathlib.Path, *files: pathlib.Path) -> None:
    as_user = [] if IS_ROOT else ["--force-not-root"]
    # The root has no shell, and the machine's cache of libraries is not ours: packages' scripts call an ldconfig that does nothing.
    scripts = root.parent / "scripts"
    scripts.mkdir(exist_ok=True)
    (scripts / "ldconfig").write_text(f"#!/bin/sh\necho called >> {scripts}/log\n")
    (scripts / "ldconfig").chmod(0o755)
    environment = os.environ | {"PATH": f"{scripts}:{os.environ['PATH']}:/usr/sbin:/sbin"}
    run("dpkg", f"--root={root}", "--log=/dev/null", "--force-script-chrootless", *as_user, "--install", *files, env=environment)


class DebianPackages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="coapt-packages-")
        folder = pathlib.Path(cls.folder.name)
        before = (BUILD / "bin/coapt").stat().st_mtime
        run(CPACK, "-G", "DEB", "--config", BUILD / "CPackConfig.cmake", "-B", folder / "packages")
        assert (BUILD / "bin/coapt").stat().st_mtime == before, "packing has built something"
        cls.files = {p.name.split("_")[0]: p for p in (folder / "packages").glob("*.deb")}
        cls.root = folder / "root"
        clean_root.make_database(cls.root, ", ".join(map(depends, cls.files.values())))
        install(cls.root, *cls.files.values())

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_is_installed_and_configured(self):
        for package in self.files:
            state = run("dpkg-query", f"--admindir={self.root}/var/lib/dpkg", "-W", "-f", "${Status}", package)
            self.assertEqual(state, "install ok installed", package)

    def test_licences_are_apart(self):
        for package, file in self.files.items():
            needs = depends(file)
            copyright_text = (self.root / "usr/share/doc" / package / "copyright").read_text()
            licence = re.search(r"Licence of this package: (.*)\.", copyright_text)[1]
            self.assertIn("Redistribution and use in source and binary forms", copyright_text)
            if package == "libcoapt-dev" or re.fullmatch(r"libcoapt[\d.]+", package):
                self.assertEqual(licence, "BSD-3-Clause")
                self.assertIsNone(re.search("ceres|cgal|nlopt|suitesparse|cholmod", needs), needs)
            elif package == "coapt":
                self.assertIn(f"Licence: {licence}\n", run(self.root / "usr/bin/coapt", "--version") + "\n")
            elif package == "python3-coapt":
                self.assertIn("python3-numpy", needs)
                self.assertEqual(self.python("print(coapt.licence())").strip(), licence)
            else:
                self.assertRegex(licence, r"^(GPL-.* as a whole|BSD-3-Clause \(with LGPL-)")
                self.assertIn("libcoapt-dev (= ", needs)

    def test_no_file_is_in_two_packages_and_none_outside_usr(self):
        seen: dict[str, str] = {}
        for package, file in self.files.items():
            for line in run("dpkg-deb", "-c", file).splitlines():
                mode, path = line.split()[0], line.split()[5]
                if mode.startswith("d"):
                    continue
                self.assertTrue(path.startswith("./usr/"), path)
                self.assertNotIn(path, seen)
                seen[path] = package

    def python(self, code: str) -> str:
        """Runs it with the module of the root, which Python finds before any other."""
        place = self.root / "usr/lib/python3/dist-packages"
        code = f"import coapt\nassert coapt.__file__.startswith({str(place)!r})\n" + code
        return run("/usr/bin/python3", "-B", "-c", code, env={"PYTHONPATH": str(place), "PATH": "/usr/bin"}, cwd="/")

    def libraries(self, program: str = "usr/bin/coapt") -> list[str]:
        found = []
        for line in run("ldd", self.root / program).splitlines():
            path = re.search(r"(/\S+) \(0x", line)
            if path:
                found.append(path[1])
        return found

    def assert_libraries_come_from_dependencies(self, package: str, program: str):
        # Of two packages with a libblas.so.3 the machine may have chosen the other.
        allowed = closure(depends(self.files[package]), every_choice=True)
        for library in self.libraries(program):
            self.assertIn(owner(library), allowed, library)

    def modules(self) -> list[str]:
        """What the command loads when it needs it, in a folder of its package."""
        return [str(file.relative_to(self.root)) for file in self.root.glob("usr/lib/**/coapt/coapt-*.so")]

    def test_every_library_of_the_command_comes_from_a_dependency(self):
        self.assert_libraries_come_from_dependencies("coapt", "usr/bin/coapt")
        self.assertNotRegex(run("readelf", "-d", self.root / "usr/bin/coapt"), "R(UN)?PATH")
        for module in self.modules():
            self.assert_libraries_come_from_dependencies("coapt", module)
            self.assertNotRegex(run("readelf", "-d", self.root / module), "R(UN)?PATH")
            self.assertIn(f"./{module}", run("dpkg-deb", "-c", self.files["coapt"]))

    def test_the_python_module_solves_beside_all_that_this_machine_has(self):
        if "python3-coapt" not in self.files:
            self.skipTest("the build has no Python module")
        module = next(self.root.glob("usr/lib/python3/dist-packages/coapt/_core.*.so")).relative_to(self.root)
        self.assert_libraries_come_from_dependencies("python3-coapt", str(module))
        self.assertIn("converged", self.python(f"print(coapt.solve({str(DISC / 'scene.json')!r}).message)"))
        self.assertIn("coapt 0.", self.python("import importlib.metadata as m\nd = m.distribution('coapt')\n"
                                              "print(d.metadata['Name'], d.version)"))

    def test_the_python_module_solves_with_what_it_depends_on(self):
        if "python3-coapt" not in self.files:
            self.skipTest("the build has no Python module")
        if not IS_ROOT:
            self.skipTest("python3-coapt among its dependencies alone: only root can make that root and chroot into it")
        root, file = pathlib.Path(self.folder.name) / "python", self.files["python3-coapt"]
        clean_root.make(root, depends(file))
        install(root, file)
        shutil.copytree(DISC, root / "disc")
        code = "import coapt; print(coapt.__file__, coapt.solve('/disc/scene.json').message)"
        answer = clean_root.chroot(root, "/usr/bin/python3", "-B", "-c", code)
        self.assertRegex(answer, "^/usr/lib/python3/dist-packages/coapt/.* converged")

    def test_solves_a_generated_valve_in_the_clean_root(self):
        coapt = [self.root / "usr/bin/coapt"]
        place = self.root / "valve"
        inside = place
        if IS_ROOT:
            programs = ["usr/bin/coapt", *self.modules()]
            for library in {library for program in programs for library in self.libraries(program)}:
                copy = self.root / library.lstrip("/")
                copy.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(library, copy)
            coapt, inside = ["chroot", self.root, "/usr/bin/coapt"], pathlib.Path("/valve")
        run(*coapt, "generate", "mitral", "--triangles", "300", "-o", inside)
        run(*coapt, "solve", inside / "scene.json", "--max-seconds", "100")
        result = json.loads((place / "result/result.json").read_text())
        self.assertEqual(result["status"], "converged")
        self.assertLess(result["residual"], 1e-8)
        self.assertGreater(result["metrics"]["annulus_area_mm2"], 10 * result["metrics"]["orifice_area_mm2"])
        parts = re.findall(r"with    (\w+)", run(*coapt, "--version"))
        if "NLopt" in parts:
            run(*coapt, "generate", "disc", "--triangles", "200", "-o", inside / "disc")
            run(*coapt, "solve", inside / "disc/scene.json", "--solver", "nlopt", "--tolerance", "1e-6", "--max-seconds", "100")
            self.assertTrue(json.loads((place / "disc/result/result.json").read_text())["converged"])
        if "ITKImage" in parts:
            run(*coapt, "phantom", inside / "scene.json", "--voxel", "2mm", "-o", inside / "phantom")
            self.assertIn("voxels", run(*coapt, "image", "info", inside / "phantom/open/image.nrrd"))

    def test_serves_a_project_through_pkg_config(self):
        if not shutil.which("pkg-config"):
            self.skipTest("pkg-config is not installed")
        paths = [str(p) for p in self.root.glob("usr/lib/**/pkgconfig")]
        environment = os.environ | {"PKG_CONFIG_PATH": ":".join(paths)}
        flags = run("pkg-config", "--cflags", "--libs", "coapt", env=environment).split()
        self.assertIn("-lcoapt_core", flags)
        program = pathlib.Path(self.folder.name) / "consumer"
        run(COMPILER, "-std=c++20", "-O1", CONSUMER, "-o", program, *flags)
        self.assertIn("theory", run(program))
        self.serves_the_shared_library(environment)
        for package in self.files:
            if match := re.fullmatch(r"lib(coapt-\w+)-dev", package):
                libraries = run("pkg-config", "--libs", match[1], env=environment).split()
                self.assertLess(libraries.index(f"-l{match[1].replace('-', '_')}"), libraries.index("-lcoapt_optim"))

    def serves_the_shared_library(self, environment: dict):
        flags = run("pkg-config", "--cflags", "--libs", "coapt-shared", env=environment).split()
        program = pathlib.Path(self.folder.name) / "consumer_shared"
        run(COMPILER, "-std=c++20", "-O1", CONSUMER, "-o", program, *flags)
        library, = self.root.glob("usr/lib/**/libcoapt.so")
        owners = [package for package, file in self.files.items() if "/libcoapt.so.0" in run("dpkg-deb", "-c", file)]
        self.assertEqual(len(owners), 1)
        self.assertRegex(owners[0], r"^libcoapt\d+\.\d+$")
        self.assertIn("theory", run(program, env=environment | {"LD_LIBRARY_PATH": str(library.parent)}))
        self.assert_libraries_come_from_dependencies(owners[0], str(library.relative_to(self.root)))
        self.assertTrue((self.root.parent / "scripts/log").exists(), "no script has called ldconfig")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
