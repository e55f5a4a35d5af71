"""Files that the command exports and imports."""
import unittest

from command_case import CommandCase, coapt


class ExchangeTest(CommandCase):
    def test_exports_and_imports_a_febio_model(self):
        scene, model, copy = self.generate("mitral", "--triangles", 300), self.folder / "m.feb", self.folder / "copy"
        run = coapt("export", scene, "-o", model)
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        self.assertIn("warning: ", run.stdout)
        run = coapt("import", model, "-o", copy)
        if "rebuild with pugixml" in run.stderr:
            self.skipTest("skipped: built without pugixml")
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        self.assertEqual(coapt("check", copy / "scene.json").returncode, 0)
        model.write_text(model.read_text()[:5000])
        self.assert_bad_input(coapt("import", model, "-o", copy), "m.feb", "XML")

    def test_exports_meshes_and_points_and_imports_them(self):
        scene = self.generate("mitral", "--triangles", 300)
        for name in ["leaflets.ply", "tips.mrk.json", "ring.mrk.json"]:
            points = "papillary" if name.startswith("tips") else "annulus_closed"
            run = coapt("export", scene, "-o", self.folder / name, *(["--points", points] if "mrk" in name else []))
            self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        out = self.folder / "out"
        run = coapt("import", self.folder / "leaflets.ply", "--annulus-closed", self.folder / "ring.mrk.json",
                    "--papillary", self.folder / "tips.mrk.json", "-o", out)
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        self.assertIn("chords", run.stdout)
        run = coapt("check", out / "scene.json")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        for name in ["nothing.inp", "nothing.feb", "nothing.obj", "nothing.xyz"]:
            self.assert_bad_input(coapt("import", self.folder / name, "-o", out), name)
        self.assert_bad_input(coapt("export", scene, "-o", self.folder / "x.doc"), "x.doc")
        self.assert_bad_input(coapt("export", scene, "-o", self.folder / "x.mrk.json", "--points", "anulus"), "annulus")

    def test_imports_linear_leaflets_and_chords_where_asked(self):
        self.generate("mitral", "--triangles", 300)
        out = self.folder / "linear"
        run = coapt("import", self.folder / "valve.json", "--young", "2 MPa", "--chord-young", "30 MPa", "-o", out)
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        text = (out / "scene.json").read_text()
        self.assertIn('"young": "2 MPa"', text)
        self.assertIn('"young": "30 MPa"', text)
        run = coapt("import", self.folder / "valve.json", "--young", "2 mm", "--chord-young", "-1 MPa", "-o", out)
        self.assert_bad_input(run, "young", "mm", "chord_young: must be positive")

    def test_does_not_write_over_what_it_reads(self):
        scene = self.generate("mitral", "--triangles", 300)
        scene.write_text(scene.read_text() + "// mine\n")
        before = {path.name: path.read_bytes() for path in self.folder.iterdir()}
        for file in ["valve.json", "leaflets.obj"]:
            self.assert_bad_input(coapt("import", self.folder / file, "-o", self.folder), "another folder")
            self.assert_bad_input(coapt("import", file, "-o", ".", cwd=self.folder), "another folder")
        made = self.folder / "made"
        run = coapt("chords", self.folder / "valve.json", "-o", made / "leaflets.obj")
        self.assert_bad_input(run, "leaflets.obj", ".json")
        self.assertFalse(made.exists())
        self.assertEqual({path.name: path.read_bytes() for path in self.folder.iterdir()}, before)


if __name__ == "__main__":
    unittest.main(argv=[__file__])
