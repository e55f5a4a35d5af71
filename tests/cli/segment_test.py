"""`coapt segment` and `coapt image slices`: methods, what is written, and what is said of images that cannot be used."""
import gzip
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

from command_case import COAPT, CommandCase, coapt

IMAGE = ("--voxel", "0.6mm", "--psf", "0.5mm", "0.5mm", "--dropout", 0, "--shadows", 0, "--wall", "0mm")
SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts/real-image-check"


def fields_and_voxels(path):
    fields, voxels = path.read_bytes().split(b"\n\n", 1)
    return fields.decode(), gzip.decompress(voxels)


def numbers_in(obj):
    return [float(word) for line in obj.read_text().splitlines() for word in line.split()[1:]]


class SegmentAnImage(CommandCase):
    """A generated valve without chords."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        folder = pathlib.Path(scratch.name)
        for run in (coapt("generate", "mitral", "--triangles", 600, "-o", folder / "valve"),
                    coapt("phantom", folder / "valve/scene.json", *IMAGE, "-o", folder / "phantom", timeout=600)):
            if run.returncode != 0:
                raise AssertionError(run.stdout + run.stderr)
        cls.opened = folder / "phantom/open"
        cls.image, cls.ring = cls.opened / "image.nrrd", cls.opened / "annulus.mrk.json"

    def segment(self, *options, image=None):
        return coapt("segment", image or self.image, "--annulus", self.ring, "-o", self.folder / "out", *options, timeout=600)

    def found(self, *options, image=None):
        run = self.segment(*options, image=image)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return json.loads((self.folder / "out/segmentation.json").read_text()), run.stdout

    def distances(self):
        run = coapt("register", self.folder / "out/leaflets.obj", self.opened / "surface.obj", "--method", "surface", "-o",
                    self.folder / "registered")
        self.assertEqual(run.returncode, 0, run.stderr)
        figures = json.loads((self.folder / "registered/registration.json").read_text())["distances_before"]
        return figures["to_target"]["mean_mm"], figures["from_target"]["mean_mm"]

    def labelled(self, label):
        """A volume that is 200 where the phantom has this label, and 20 elsewhere: a micro-CT without noise."""
        fields, labels = fields_and_voxels(self.opened / "labels.nrrd")
        path = self.folder / "labelled.nrrd"
        path.write_bytes(fields.encode() + b"\n\n" + gzip.compress(bytes(200 if x == label else 20 for x in labels)))
        return path

    def test_an_isosurface_lies_on_the_side_of_the_atrium(self):
        image = self.labelled(3)
        self.found("--method", "isosurface", "--threshold", 110, image=image)
        truth = [list(map(float, line.split()[1:4])) for line in (self.opened / "surface.obj").read_text().splitlines() if line.startswith("v ")]
        points = [list(map(float, line.split()[1:4])) for line in (self.folder / "out/leaflets.obj").read_text().splitlines() if line.startswith("v ")]
        axis = [sum(p[0] for p in truth) / len(truth), sum(p[1] for p in truth) / len(truth)]
        inside = [math.hypot(p[0] - axis[0], p[1] - axis[1]) for p in points]
        middles = []
        for p in points:
            q = min(truth, key=lambda v: math.dist(v, p))
            middles.append(math.hypot(q[0] - axis[0], q[1] - axis[1]))
        nearer = sum(a - b for a, b in zip(middles, inside)) / len(points)
        self.assertGreater(nearer, 0.15)  # mm towards the axis, which is the atrium's side of an open valve; half of 1 mm, less the mesh
        to_truth, from_truth = self.distances()
        self.assertLess(to_truth, 0.8)
        self.assertGreater(to_truth, 0.2)

    def test_options_that_belong_to_another_method_are_refused(self):
        self.assert_bad_input(self.segment("--threshold", 3, "--method", "ridge"), "--threshold", "isosurface")
        self.assert_bad_input(self.segment("--inhibition", "edge", "--method", "ridge"), "--inhibition", "burlina-2010")
        self.assert_bad_input(self.segment("--template", "valve.json", "--method", "ridge"), "--template", "template")
        self.assert_bad_input(self.segment("--second-route", "--method", "isosurface"), "two routes")

    def test_a_template_finds_what_the_first_route_does(self):
        figures, said = self.found("--method", "template", "--dynamic-range", 50, "--second-route")
        for mean in self.distances():
            self.assertLess(mean, 0.3)
        other = figures["second_route"]
        self.assertLess(other["mean_mm"], 0.3)
        self.assertGreater(other["p95_mm"], other["mean_mm"])
        self.assertIn("second route", said)
        self.assertIn(b"second_route_mm", (self.folder / "out/leaflets.vtp").read_bytes())

    def test_a_valve_of_ones_own_is_a_template(self):
        valve = self.folder / "other/valve.json"
        run = coapt("generate", "mitral", "--seed", 7, "--triangles", 600, "-o", valve.parent)
        self.assertEqual(run.returncode, 0, run.stderr)
        options = ("--method", "template", "--dynamic-range", 50, "--template", valve)
        self.found(*options)
        for mean in self.distances():
            self.assertLess(mean, 0.3)
        scene = valve.parent / "scene.json"
        self.assert_bad_input(self.segment(*options[:-1], scene), "scene.json", "is a scene", "a valve JSON")
        without = json.loads(valve.read_text())
        del without["free_edge"]
        valve.write_text(json.dumps(without))
        self.assert_bad_input(self.segment(*options), "valve.json", "annulus or no free edge")

    def test_burlinas_method_leaves_its_pieces_and_a_valve(self):
        seeds = self.folder / "seeds.mrk.json"

        def marks(*points):
            controls = [{"position": point, "label": str(number)} for number, point in enumerate(points)]
            seeds.write_text(json.dumps({"markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "controlPoints": controls}]}))
        ring = [point["position"] for point in json.loads(self.ring.read_text())["markups"][0]["controlPoints"]]
        middle = [sum(point[axis] for point in ring) / len(ring) for axis in range(3)]
        marks(middle)
        options = ("--method", "burlina-2010", "--dynamic-range", 50, "--seeds", seeds)
        self.assert_bad_input(self.segment(*options), "seeds.mrk.json", "expected 2")
        marks(middle, [middle[0], middle[1], middle[2] - 24])
        figures, _ = self.found(*options, "--keep")
        self.assertGreater(figures["level_set"]["steps"], 50)
        for mean in self.distances():
            self.assertLess(mean, 0.4)
        chambers = fields_and_voxels(self.folder / "out/chambers.nrrd")[1]
        self.assertEqual(set(chambers), {0, 1, 2})
        for name in ("thin_tissue.nrrd", "tissue_mask.nrrd", "evidence.nrrd"):
            self.assertTrue((self.folder / "out" / name).exists(), name)

    def changed(self, name, change, voxels=lambda data: data):
        fields, data = fields_and_voxels(self.image)
        path = self.folder / name
        path.write_bytes(change(fields).encode() + b"\n\n" + gzip.compress(voxels(data)))
        return path

    def test_bad_images_are_named_with_the_remedy(self):
        self.assert_bad_input(coapt("segment", self.image, "-o", self.folder / "out"), "--annulus")
        empty = self.folder / "empty.nrrd"
        empty.write_bytes(b"")
        self.assert_bad_input(self.segment(image=empty), "empty.nrrd", "is empty")
        short = self.changed("short.nrrd", lambda fields: fields, lambda data: data[:len(data) // 2])
        run = self.segment(image=short)
        self.assert_bad_input(run, "short.nrrd", "cannot be read: expected", "again")
        self.assertNotIn("[nrrd]", run.stderr)  # the names of functions within a library
        bare = self.changed("bare.nrrd", lambda fields: "\n".join(
            line for line in fields.split("\n") if not line.startswith(("space", "kinds"))))
        self.assert_bad_input(self.segment(image=bare), "bare.nrrd", "how large its voxels are", "image convert --spacing")
        sizes = next(line for line in fields_and_voxels(self.image)[0].split("\n") if line.startswith("sizes"))
        huge = self.changed("huge.nrrd", lambda fields: fields.replace(sizes, "sizes: 10000 10000 10000"))
        self.assert_bad_input(self.segment(image=huge), "huge.nrrd", "1e+12 voxels", "crop it")
        flat = self.folder / "flat.nrrd"
        flat.write_bytes(b"NRRD0005\ntype: uint8\ndimension: 2\nsizes: 2 3\nspacings: 1 1\nencoding: raw\n\n" + bytes(6))
        self.assert_bad_input(self.segment(image=flat), "flat.nrrd", "flat image")
        series = self.folder / "v.seq.nrrd"
        series.write_bytes(b"NRRD0005\ntype: uint8\ndimension: 4\nspace: LPS\nsizes: 2 2 3 4\nkinds: list domain domain domain\n"
                           b"space directions: none (1,0,0) (0,1,0) (0,0,1)\nencoding: raw\n\n" + bytes(48))
        self.assert_bad_input(self.segment(image=series), "v.seq.nrrd", "2 frames", "--frame")
        dicom = self.folder / "broken.dcm"
        dicom.write_bytes(bytes(128) + b"DICM" + bytes(range(200)))
        self.assert_bad_input(self.segment(image=dicom), "broken.dcm")
        same = self.changed("same.nrrd", lambda fields: fields, lambda data: bytes([7]) * len(data))
        self.assert_bad_input(self.segment(image=same), "same.nrrd", "same value everywhere")
        self.assertFalse((self.folder / "out").exists())

    def test_a_grid_without_directions_is_warned_of_and_so_are_long_voxels(self):
        def bare(fields):
            kept = [line for line in fields.split("\n") if not line.startswith(("space", "kinds"))]
            return "\n".join(kept[:-1] + ["spacings: 0.6 0.6 1.2", kept[-1]])
        run = self.segment("--dynamic-range", 50, image=self.changed("bare.nrrd", bare))
        self.assertIn("does not say how its axes lie", run.stdout)
        self.assertIn("2 times as long as wide", run.stdout)
        self.assertNotIn("Traceback", run.stderr)
        self.assertIn(run.returncode, (0, 2))

    def test_sixteen_bits_give_what_eight_give(self):
        self.found("--dynamic-range", 50)
        eight = numbers_in(self.folder / "out/leaflets.obj")
        wide = self.folder / "wide.nrrd"
        self.assertEqual(coapt("image", "convert", self.image, "--kind", "uint16", "-o", wide).returncode, 0)
        self.found("--dynamic-range", 50, image=wide)
        sixteen = numbers_in(self.folder / "out/leaflets.obj")
        self.assertEqual(len(sixteen), len(eight))
        self.assertLess(max(abs(a - b) for a, b in zip(sixteen, eight)), 1e-9)  # in another scale, so but for rounding

    def test_slices_are_drawn_with_the_surfaces_on_them(self):
        plain, drawn = self.folder / "plain.png", self.folder / "drawn.png"
        run = coapt("image", "slices", self.image, "--annulus", self.ring, "-o", plain)
        self.assertEqual(run.returncode, 0, run.stderr)
        run = coapt("image", "slices", self.image, "--annulus", self.ring, "--surface", self.opened / "surface.obj", "-o", drawn)
        self.assertEqual(run.returncode, 0, run.stderr)
        for path in (plain, drawn):
            self.assertEqual(path.read_bytes()[1:4], b"PNG")
        self.assertNotEqual(plain.read_bytes(), drawn.read_bytes())
        sheets = self.folder / "sheets.png"
        run = coapt("image", "slices", self.image, "--annulus", self.ring, "--sheets", "-o", sheets)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertNotIn(sheets.read_bytes(), (plain.read_bytes(), drawn.read_bytes()))
        self.assert_bad_input(coapt("image", "slices", self.image, "-o", self.folder / "a.jpg"), "a.jpg", ".png")

    def test_ultrasound_without_its_dynamic_range_is_warned_of(self):
        run = coapt("segment", self.image, "--annulus", self.ring, "-o", self.folder / "linear")
        self.assertIn("--dynamic-range", run.stdout)
        run = coapt("segment", self.image, "--annulus", self.ring, "--dynamic-range", 50, "-o", self.folder / "decibels")
        self.assertNotIn("--dynamic-range", run.stdout)

    def check(self, *arguments):
        return subprocess.run([SCRIPT, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder, timeout=600, check=False,
                              env={**os.environ, "COAPT": COAPT})

    def test_the_check_of_real_images_goes_from_the_file_to_the_leaflets(self):
        run = self.check(self.image)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("no annulus was given", run.stdout)
        out = self.folder / "real-image-check"
        self.assertEqual(json.loads((out / "info.json").read_text())["voxel_kind"], "uint8")
        self.assertEqual((out / "slices.png").read_bytes()[1:4], b"PNG")
        self.assertEqual((out / "sheets.png").read_bytes()[1:4], b"PNG")
        page = (out / "page.html").read_text()
        self.assertEqual(page.count("data:image/png;base64,"), 2)
        self.assertIn("no annulus was given", page)
        shutil.rmtree(out)
        run = self.check(self.image, self.ring, "--", "--dynamic-range", 50)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertTrue((out / "leaflets/valve.json").exists())
        self.assertIn("thickness", (out / "report.txt").read_text())
        self.assertEqual((out / "leaflets.png").read_bytes()[1:4], b"PNG")
        self.assertEqual((out / "page.html").read_text().count("data:image/png;base64,"), 3)
        self.assertNotEqual(self.check(self.folder / "none.nrrd").returncode, 0)


if __name__ == "__main__":
    unittest.main(argv=[__file__])
