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


def dicom_slice(number, height, values):
    """2 x 3 voxels of 16 bits in explicit VR little endian (DICOM PS3.5 and PS3.10)."""
    def element(group, tag, kind, value):
        if len(value) % 2:
            value += b"\0" if kind in ("UI", "OB") else b" "
        long = kind in ("OW", "OB")
        return struct.pack("<HH2s", group, tag, kind.encode()) + struct.pack("<HI" if long else "<H", *([0] if long else []), len(value)) + value
    ct, instance, whole = b"1.2.840.10008.5.1.4.1.1.2", f"1.2.3.4.{number}".encode(), lambda n: struct.pack("<H", n)
    meta = element(2, 1, "OB", b"\0\1") + element(2, 2, "UI", ct) + element(2, 3, "UI", instance) + element(
        2, 0x10, "UI", b"1.2.840.10008.1.2.1") + element(2, 0x12, "UI", b"1.2.3")
    texts = ((0x8, 0x16, "UI", ct), (0x8, 0x18, "UI", instance), (0x8, 0x60, "CS", b"CT"), (0x20, 0xd, "UI", b"1.2.3.9"),
             (0x20, 0xe, "UI", b"1.2.3.4"), (0x20, 0x13, "IS", str(number).encode()), (0x20, 0x32, "DS", f"10\\20\\{height}".encode()),
             (0x20, 0x37, "DS", b"0\\1\\0\\-1\\0\\0"), (0x28, 2, "US", whole(1)), (0x28, 4, "CS", b"MONOCHROME2"),
             (0x28, 0x10, "US", whole(3)), (0x28, 0x11, "US", whole(2)), (0x28, 0x30, "DS", b"0.6\\0.5"), (0x28, 0x100, "US", whole(16)),
             (0x28, 0x101, "US", whole(16)), (0x28, 0x102, "US", whole(15)), (0x28, 0x103, "US", whole(0)),
             (0x7fe0, 0x10, "OW", struct.pack("<6H", *values)))
    return bytes(128) + b"DICM" + element(2, 0, "UL", struct.pack("<I", len(meta))) + meta + b"".join(element(*text) for text in texts)


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

    def test_a_dicom_series_is_read_and_a_broken_one_does_not_end_the_command(self):
        series = self.folder / "series"
        series.mkdir()
        for k in range(4):  # names in another order than the slices
            (series / f"slice{9 - k}").write_bytes(dicom_slice(4 - k, 30 + 0.7 * k, range(6 * k, 6 * k + 6)))
        info = self.info(series)
        self.assertEqual((info["format"], info["voxel_kind"], info["size"], info["range"]), ("DICOM", "uint16", [2, 3, 4], [0, 23]))
        for found, wanted in zip(info["spacing_mm"] + info["origin_mm"] + info["direction"][0], [0.5, 0.6, 0.7, 10, 20, 30, 0, 1, 0]):
            self.assertAlmostEqual(found, wanted, 6)
        out = self.folder / "w.nrrd"
        self.assertEqual(coapt("image", "convert", series, "-o", out).returncode, 0)
        self.assertEqual((self.info(out)["size"], self.info(out)["range"]), ([2, 3, 4], [0, 23]))
        whole = (series / "slice9").read_bytes()
        for length in range(140, len(whole), 23):  # at some of these GDCM ends its process, which is a copy of the command
            (series / "slice9").write_bytes(whole[:length])
            self.assert_bad_input(coapt("image", "info", series), "series")

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
