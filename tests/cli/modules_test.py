"""Parts of the command that are loaded when they are first needed: what most scenes do not use costs their start nothing.

Usage: modules_test.py COAPT_BINARY [unittest arguments]
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

from command_case import COAPT, CommandCase, coapt

MODULES = next((file.parent for file in pathlib.Path(COAPT).parent.parent.glob("lib/**/coapt-*.so")), pathlib.Path())
PARTS = re.findall(r"with    (\w+)", coapt("--version").stdout)


def has(part):
    return unittest.skipUnless(part in PARTS, f"this build has no {part}")


class ModulesTest(CommandCase):
    def disc(self):
        return self.generate("disc", "--triangles", 200)

    def valve(self):
        return self.generate("mitral", "--triangles", 250, "--contact", "none")

    def loaded(self, *arguments):
        """The libraries that the dynamic linker finds for a run which ends well."""
        said = self.folder / "linker"
        run = subprocess.run([COAPT, *map(str, arguments)], capture_output=True, text=True, timeout=300,
                             env=os.environ | {"LD_DEBUG": "files", "LD_DEBUG_OUTPUT": str(said)})
        self.assertEqual(run.returncode, 0, run.stderr)
        text = "".join(file.read_text() for file in self.folder.glob("linker.*"))
        names = {pathlib.Path(name).name for name in re.findall(r"file=(\S+)", text)}
        self.assertTrue(any(name.startswith("libc.so") for name in names), "the linker says nothing")
        return names

    def alone(self):
        """The command in a folder of its own, as where a part of an installation is lost."""
        copy = self.folder / "alone" / "bin" / "coapt"
        copy.parent.mkdir(parents=True)
        shutil.copy(COAPT, copy)
        return copy

    def test_a_solve_loads_no_part_that_it_does_not_use(self):
        for arguments in [("--version",), ("solve", self.disc(), "-o", self.folder / "out"), ("check", self.folder / "scene.json")]:
            found = {name for name in self.loaded(*arguments)
                     if re.match(r"(coapt-|lib(ITK|itk|gdcm|openblas|cholmod|ceres|glog|nlopt|lapack|gomp))", name)}
            self.assertEqual(found, set(), arguments)

    @has("NLopt")
    def test_nlopt_is_loaded_when_it_is_asked_for(self):
        found = self.loaded("solve", self.disc(), "--solver", "nlopt", "--tolerance", "1e-6", "-o", self.folder / "out")
        self.assertIn("coapt-adapters.so", found)

    @has("Ceres")
    def test_ceres_solves(self):
        run = coapt("solve", self.disc(), "--solver", "ceres", "--tolerance", "1e-6", "-o", self.folder / "out")
        self.assertEqual(run.returncode, 0, run.stderr)

    @has("CHOLMOD")
    def test_cholmod_takes_its_kernels_from_openblas_and_solves_as_the_others_do(self):
        """Ceres brings another BLAS along: the loader says which one CHOLMOD is bound to."""
        scene = self.disc()
        text = scene.read_text()
        energies = {}
        for factorisation in ("multifrontal", "cholmod"):
            scene.write_text(text.replace('"solver": {', f'"solver": {{ "factorisation": "{factorisation}", ', 1))
            run = subprocess.run([COAPT, "solve", str(scene), "-o", str(self.folder / "out")], capture_output=True, text=True,
                                 timeout=300, env=os.environ | {"LD_DEBUG": "bindings"})
            self.assertEqual(run.returncode, 0, run.stderr[-1000:])
            energies[factorisation] = self.result(self.folder / "out")["energy_mj"]
            bound = set(re.findall(r"libcholmod\S* \[\d+\] to (\S+) \[\d+\]: normal symbol `dgemm_'", run.stderr))
            if factorisation == "cholmod":
                self.assertTrue(bound and all("libopenblas" in library for library in bound), bound)
            else:
                self.assertEqual(bound, set())
        self.assertAlmostEqual(energies["cholmod"] / energies["multifrontal"], 1, places=9)

    def test_every_minimiser_of_a_build_can_be_loaded(self):
        scene = self.valve()
        known = coapt("tune", scene, "--method", "none", "--target", scene).stderr
        names = set(re.search(r"there are: (.*)", known)[1].split(", ")) - {"gauss_newton"}
        self.assertEqual("slsqp" in names, "NLopt" in PARTS, known)
        self.assertEqual("ceres" in names, "Ceres" in PARTS, known)
        run = coapt("solve", scene, "-o", self.folder / "closed")
        self.assertEqual(run.returncode, 0, run.stderr)
        for name in names:
            run = coapt("tune", scene, "--method", name, "--target", self.folder / "closed" / "closed.vtp", "--max-solves", 2,
                        "-o", self.folder / name, timeout=300)
            self.assertIn(run.returncode, (0, 1), run.stderr)
            self.assertTrue((self.folder / name / "tuning.json").exists(), run.stderr)

    @has("NLopt")
    def test_a_part_that_is_lost_is_named_when_it_is_needed(self):
        copy, scene = self.alone(), self.disc()
        run = subprocess.run([copy, "solve", scene, "-o", self.folder / "out"], capture_output=True, text=True, timeout=300)
        self.assertEqual(run.returncode, 0, run.stderr)
        run = subprocess.run([copy, "solve", scene, "--solver", "nlopt", "-o", self.folder / "none"], capture_output=True,
                             text=True, timeout=300)
        self.assert_bad_input(run, "coapt-adapters.so", "install coapt again")
        self.assertFalse((self.folder / "none" / "result.json").exists())

    @has("ITKImage")
    def test_a_lost_reader_of_images_is_named(self):
        image = self.folder / "image.nrrd"
        image.write_text("NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: ascii\n\n1 2 3 4 5 6 7 8\n")
        run = subprocess.run([self.alone(), "image", "info", image], capture_output=True, text=True, timeout=300)
        self.assert_bad_input(run, "coapt-images.so", "install coapt again")

    @unittest.skipUnless((MODULES / "coapt-adapters.so").exists(), "this build has no adapters")
    def test_a_part_of_another_build_is_refused(self):
        copy = self.alone()
        folder = self.folder / "alone" / MODULES.relative_to(pathlib.Path(COAPT).parent.parent)
        folder.mkdir(parents=True)
        shutil.copy(MODULES / "coapt-images.so", folder / "coapt-adapters.so")
        part = (folder / "coapt-adapters.so").read_bytes()
        version = re.search(r"coapt (\S+)", coapt("--version").stdout)[1].encode()
        self.assertIn(version + b", ", part)
        (folder / "coapt-adapters.so").write_bytes(part.replace(version + b", ", b"9" * len(version) + b", "))
        run = subprocess.run([copy, "solve", self.disc(), "--solver", "nlopt", "-o", self.folder / "none"], capture_output=True,
                             text=True, timeout=300)
        self.assert_bad_input(run, "coapt-adapters.so", "another build")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
