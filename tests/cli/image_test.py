"""`coapt image` and `coapt phantom`: what a file holds, conversions, and the image of a scene with its truth."""
import json
import struct
import unittest

from command_case import CommandCase, coapt

FIELDS = """NRRD0005
type: uint8
dimension: 3
space: right-anterior-superior
sizes: 2 3 4
space directions: (0,0.5,0) (-0.6,0,0) (0,0,0.7)
kinds: domain domain domain
space origin: (10,20,30)
encoding: raw

"""
TRUTH = ("image.nrrd", "labels.nrrd", "surface.obj", "surface.vtp", "annulus.mrk.json", "free_edge.mrk.json")


class Image(CommandCase):
    def setUp(self):
        super().setUp()
        self.volume = self.folder / "v.nrrd"
        self.volume.write_bytes(FIELDS.encode() + bytes(range(24)))

    def info(self, path, *options):
        run = coapt("image", "info", path, "--json", *options)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def test_info_says_where_a_volume_lies_and_what_it_holds(self):
        info = self.info(self.volume)
        self.assertEqual(info["size"], [2, 3, 4])
        self.assertEqual((info["format"], info["voxel_kind"], info["frames"]), ("NRRD", "uint8", 1))
        self.assertEqual(info["range"], [0, 23])
        for found, wanted in zip(info["spacing_mm"] + info["origin_mm"], [0.5, 0.6, 0.7, -10, -20, 30]):
            self.assertAlmostEqual(found, wanted, 9)
        self.assertAlmostEqual(info["direction"][0][1], -1, 9)
        self.assertAlmostEqual(info["box_mm"]["high"][0], -8.8, 9)
        run = coapt("image", "info", self.volume)
        for piece in ("2 x 3 x 4 voxels of uint8", "0.5, 0.6, 0.7 mm", "-10, -20, 30 mm (LPS", "0 to 23"):
            self.assertIn(piece, run.stdout)

    def test_info_of_a_series_wants_no_frame_and_convert_does(self):
        fields = FIELDS.replace("dimension: 3", "dimension: 4").replace("sizes:", "sizes: 2").replace(
            "directions:", "directions: none").replace("kinds:", "kinds: list")
        series = self.folder / "v.seq.nrrd"
        series.write_bytes(fields.encode() + bytes(range(48)))
        self.assertEqual(self.info(series)["frames"], 2)
        self.assertIsNone(self.info(series)["range"])
        self.assertEqual(self.info(series, "--frame", 1)["range"], [1, 47])
        out = self.folder / "w.nii.gz"
        self.assert_bad_input(coapt("image", "convert", series, "-o", out), "v.seq.nrrd", "2 frames", "--frame")
        self.assertEqual(coapt("image", "convert", series, "--frame", 1, "-o", out).returncode, 0)
        self.assertEqual(self.info(out)["range"], [1, 47])
        self.assertAlmostEqual(self.info(out)["box_mm"]["high"][0], -8.8, 5)

    def test_convert_does_not_replace_its_source(self):
        before = self.volume.read_bytes()
        self.assert_bad_input(coapt("image", "convert", self.volume, "--kind", "float32", "-o", self.volume), "v.nrrd", "another")
        self.assertEqual(self.volume.read_bytes(), before)

    def test_spacing_that_a_file_does_not_state_can_be_given(self):
        bare = self.folder / "bare.nrrd"
        bare.write_bytes(b"NRRD0005\ntype: uint8\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n\n" + bytes(24))
        self.assertIsNone(self.info(bare)["spacing_mm"])
        out = self.folder / "w.mha"
        self.assert_bad_input(coapt("image", "convert", bare, "-o", out), "how large its voxels are", "--spacing")
        self.assert_bad_input(coapt("image", "convert", bare, "--spacing", "0.5", "-o", out), "--spacing", "unit")
        self.assertEqual(coapt("image", "convert", bare, "--spacing", "0.5mm", "-o", out).returncode, 0)
        self.assertEqual(self.info(out)["spacing_mm"], [0.5, 0.5, 0.5])

    def test_bad_files_are_named_with_the_remedy(self):
        self.volume.write_bytes(b"")
        self.assert_bad_input(coapt("image", "info", self.volume), "v.nrrd", "is empty", "again")
        self.volume.write_bytes(FIELDS.replace("2 3 4", "10000 10000 10000").encode())
        self.assert_bad_input(coapt("image", "info", self.volume), "v.nrrd", "1e+12 voxels")
        self.volume.write_bytes(FIELDS.replace("uint8", "float\nendian: little").encode() + struct.pack("<24f", *[float("nan")] * 24))
        self.assert_bad_input(coapt("image", "info", self.volume), "24 of 24 voxels are no finite numbers")


class PhantomOfAScene(CommandCase):
    def phantom(self, scene, out, *options):
        run = coapt("phantom", scene, "-o", out, "--voxel", "1.5mm", "--psf", "1.5mm", "2mm", *options, timeout=600)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return json.loads((out / "phantom.json").read_text())

    def test_a_valve_open_and_closed_with_its_truth(self):
        scene = self.generate("mitral", "--triangles", 500)
        a, b = self.folder / "a", self.folder / "b"
        solved = coapt("solve", scene, "--no-report", timeout=600)
        self.assertIn(solved.returncode, (0, 4), solved.stderr)
        truth = self.phantom(scene, a, "--closed", self.folder / "result", "--seed", 3)
        self.assertEqual(truth["states"], ["open", "closed"])
        self.assertEqual(truth["seed"], 3)
        self.phantom(scene, b, "--closed", "solve", "--seed", 3)
        for state in ("open", "closed"):
            for name in TRUTH:
                self.assertTrue((a / state / name).exists(), name)
            self.assertEqual((a / state / "image.nrrd").read_bytes(), (b / state / "image.nrrd").read_bytes())
        for name in ("image.nrrd", "surface.obj", "labels.nrrd"):
            self.assertNotEqual((a / "open" / name).read_bytes(), (a / "closed" / name).read_bytes())
        info = json.loads(coapt("image", "info", a / "closed/labels.nrrd", "--json").stdout)
        self.assertEqual(info["range"], [0, 5])
        self.assertEqual(info["spacing_mm"], [1.5, 1.5, 1.5])
        marks = json.loads((a / "open/annulus.mrk.json").read_text())["markups"][0]
        self.assertEqual((marks["type"], marks["coordinateSystem"]), ("ClosedCurve", "LPS"))

    def test_what_cannot_be_made_is_refused(self):
        scene = self.generate("mitral", "--triangles", 500)
        out = self.folder / "out"
        self.assert_bad_input(coapt("phantom", scene, "--closed", self.folder / "none", "-o", out), "closed.vtp", "solve")
        self.assert_bad_input(coapt("phantom", scene, "--on-wall", "nowhere", "-o", out), "nowhere", "it has")
        self.assert_bad_input(coapt("phantom", scene, "--voxel", "0", "-o", out), "voxel", "cannot be 0")
        self.assert_bad_input(coapt("phantom", scene, "--probe", "0mm", "0mm", "0mm", "-o", out), "probe")
        other = self.folder / "other"
        other.mkdir()
        (other / "closed.vtp").write_bytes(b"<VTKFile")
        self.assert_bad_input(coapt("phantom", scene, "--closed", other, "-o", out), "closed.vtp")
        self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main(argv=[__file__])
