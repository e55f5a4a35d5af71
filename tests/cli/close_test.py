"""`coapt close`: from the image of an open valve to the closed one, and how far that is from the valve that was imaged."""
import base64
import gzip
import json
import math
import pathlib
import tempfile
import unittest

from command_case import CommandCase, coapt

LEAFLET = 3  # label of a phantom
IMAGE = ("--voxel", "0.5mm", "--psf", "0.4mm", "0.4mm", "--dropout", 0, "--shadows", 0, "--wall", "0mm")


def fields_and_voxels(path):
    fields, voxels = path.read_bytes().split(b"\n\n", 1)
    return fields, gzip.decompress(voxels)


def marks(path, kind, points):
    controls = [{"position": point, "label": str(number)} for number, point in enumerate(points)]
    path.write_text(json.dumps({"markups": [{"type": kind, "coordinateSystem": "LPS", "controlPoints": controls}]}))
    return path


def positions(path):
    return [point["position"] for point in json.loads(path.read_text())["markups"][0]["controlPoints"]]


def distance_to_polygon(point, corners):
    """From the closed polygon through the corners."""
    def to_side(a, b):
        along = [y - x for x, y in zip(a, b)]
        length = sum(x * x for x in along)
        part = sum(x * (y - z) for x, y, z in zip(along, point, a)) / length if length > 0 else 0
        return math.dist(point, [x + min(max(part, 0), 1) * y for x, y in zip(a, along)])

    return min(to_side(a, b) for a, b in zip(corners, corners[1:] + corners[:1]))


def turned(point, angle, shift):
    """About z."""
    c, s = math.cos(angle), math.sin(angle)
    return [c * point[0] - s * point[1] + shift[0], s * point[0] + c * point[1] + shift[1], point[2] + shift[2]]


class CloseAnImage(CommandCase):
    """A valve whose chords and tissue follow the rules that `close` has, so that what differs is due to the image."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.truth = cls.made_truth()

    @classmethod
    def made_truth(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        folder = pathlib.Path(scratch.name)

        def run(*arguments):
            done = coapt(*arguments, timeout=600)
            if done.returncode not in (0, 4):
                raise AssertionError(done.stdout + done.stderr)

        run("generate", "mitral", "--triangles", 600, "-o", folder / "drawn")
        valve = json.loads((folder / "drawn/valve.json").read_text())
        for key in ("chords", "junctions", "membranes", "papillary_closed"):
            valve.pop(key, None)
        (folder / "drawn/bare.json").write_text(json.dumps(valve))
        run("chords", folder / "drawn/bare.json", "--zones", "free_edge", "rough", "-o", folder / "chorded/valve.json")
        run("import", folder / "chorded/valve.json", "-o", folder / "scene")
        run("solve", folder / "scene/scene.json", "-o", folder / "result", "--no-report")
        run("phantom", folder / "scene/scene.json", "--closed", folder / "result", *IMAGE, "-o", folder / "phantom")
        marks(folder / "tips.mrk.json", "Fiducial", valve["papillary"])
        return folder

    def close(self, *options, code=(0, 4)):
        opened = self.truth / "phantom/open"
        run = coapt("close", opened / "image.nrrd", "--annulus", opened / "annulus.mrk.json", "--papillary",
                    self.truth / "tips.mrk.json", "--dynamic-range", 50, "--edge-length", "1.8mm", "-o",
                    self.folder / "out", *options, timeout=600)
        self.assertIn(run.returncode, code, run.stdout + run.stderr)
        return run

    def distance_from_truth(self):
        run = coapt("register", self.folder / "out/result/closed.obj", self.truth / "phantom/closed/surface.obj",
                    "--method", "surface", "-o", self.folder / "registered")
        self.assertEqual(run.returncode, 0, run.stderr)
        figures = json.loads((self.folder / "registered/registration.json").read_text())["distances_before"]
        return figures["to_target"]["mean_mm"], figures["from_target"]["mean_mm"]

    def assert_closed_like_the_truth(self):
        result, truth = self.result(self.folder / "out/result"), self.result(self.truth / "result")
        self.assertEqual(result["status"], "converged")
        self.assertEqual(result["metrics"]["intersections"], 0)
        self.assertLess(abs(result["metrics"]["orifice_area_mm2"] - truth["metrics"]["orifice_area_mm2"]), 15)
        self.assertGreater(result["metrics"]["annulus_area_mm2"], 700)
        for mean in self.distance_from_truth():
            self.assertLess(mean, 0.6)

    def series(self):
        """A time series of the open and the closed volume, which lie on one grid."""
        fields, opened = fields_and_voxels(self.truth / "phantom/open/image.nrrd")
        _, closed = fields_and_voxels(self.truth / "phantom/closed/image.nrrd")
        for old, new in ((b"dimension: 3", b"dimension: 4"), (b"sizes:", b"sizes: 2"), (b"directions:", b"directions: none"),
                         (b"kinds:", b"kinds: list")):
            fields = fields.replace(old, new)
        path = self.folder / "beat.seq.nrrd"
        path.write_bytes(fields + b"\n\n" + gzip.compress(bytes(value for pair in zip(opened, closed) for value in pair), 1))
        return path

    def test_an_image_becomes_a_closed_valve(self):
        closed = self.truth / "phantom/closed"
        run = self.close("--annulus-closed", closed / "annulus.mrk.json", "--closed", self.series(), "--closed-frame", 1)
        out = self.folder / "out"
        self.assert_closed_like_the_truth()
        page = (out / "result/report.html").read_text()
        self.assertIn("orifice", page)
        self.assertGreater(len(page), 100000)
        self.assertIn("Slices through the images", page)
        for name in ("slices_open.png", "slices_closed.png"):
            picture = (out / name).read_bytes()
            self.assertEqual(picture[1:4], b"PNG")
            self.assertIn("data:image/png;base64," + base64.b64encode(picture).decode(), page)
        apart = json.loads((out / "image_distance.json").read_text())
        self.assertIn(f"mean {apart['to_image']['mean_mm']:.2f}", run.stdout)
        self.assertLess(apart["to_image"]["mean_mm"], 1.2)
        self.assertGreater(apart["ridge_points"], 1000)
        line = apart["coaptation_line"]
        self.assertGreater(line["shown_share"], 0.5)
        self.assertLess(line["to_predicted"]["mean_mm"], 2)
        self.assertIn(f"shows {100 * line['shown_share']:.0f} % of it", run.stdout)
        self.assertIn(f"shows {100 * line['shown_share']:.0f} % of it", page)
        self.assertIn('Name="in_image"', (out / "coaptation_lines.vtp").read_text(errors="replace"))
        self.assertIn('Name="distance_to_image_mm"', (out / "image_distance.vtp").read_text(errors="replace"))
        ring, given = json.loads((out / "scene/valve.json").read_text())["annulus_closed"], positions(closed / "annulus.mrk.json")
        self.assertLess(max(distance_to_polygon(p, given) for p in ring), 0.3)

    def test_a_mask_takes_the_place_of_the_image(self):
        fields, labels = fields_and_voxels(self.truth / "phantom/open/labels.nrrd")
        mask = self.folder / "mask.nrrd"
        mask.write_bytes(fields + b"\n\n" + gzip.compress(bytes(label == LEAFLET for label in labels)))
        self.close("--mask", mask, "--annulus-closed", self.truth / "phantom/closed/annulus.mrk.json")
        self.assert_closed_like_the_truth()
        self.assertFalse((self.folder / "out/image_distance.json").exists())

    def turned_closed_volume(self, angle, shift):
        """The closed volume and its annulus in a frame of their own."""
        closed = self.truth / "phantom/closed"
        fields, voxels = fields_and_voxels(closed / "image.nrrd")
        lines = []
        for line in fields.decode().split("\n"):
            name, _, value = line.partition(": ")
            if name in ("space directions", "space origin"):
                moves = shift if name == "space origin" else [0, 0, 0]
                vectors = [turned([float(x) for x in word.strip("()").split(",")], angle, moves) for word in value.split()]
                line = f"{name}: " + " ".join("(" + ",".join(map(repr, vector)) + ")" for vector in vectors)
            lines.append(line)
        volume = self.folder / "turned.nrrd"
        volume.write_bytes("\n".join(lines).encode() + b"\n\n" + gzip.compress(voxels))
        ring = [turned(point, angle, shift) for point in positions(closed / "annulus.mrk.json")]
        return volume, marks(self.folder / "turned.mrk.json", "ClosedCurve", ring)

    def test_a_closed_volume_in_another_frame_is_registered(self):
        volume, ring = self.turned_closed_volume(0.3, [12, -7, 20])
        run = self.close("--closed", volume, "--annulus-closed", ring, "--register")
        self.assertRegex(run.stdout, r"turned by 1[5-9]\.?\d* degrees")  # 0.3 rad are 17.2 degrees
        apart = json.loads((self.folder / "out/image_distance.json").read_text())
        self.assertLess(apart["to_image"]["mean_mm"], 1.5)
        self.assertLess(abs(self.result(self.folder / "out/result")["metrics"]["annulus_area_mm2"] - 755), 20)

    def test_tips_move_to_where_they_are_in_the_closed_valve(self):
        tips = [[x, y, z + 1] for x, y, z in positions(self.truth / "tips.mrk.json")]
        moved = marks(self.folder / "moved.mrk.json", "Fiducial", tips)
        self.close("--papillary-closed", moved, "--annulus-closed", self.truth / "phantom/closed/annulus.mrk.json")
        valve = json.loads((self.folder / "out/scene/valve.json").read_text())
        self.assertLess(max(math.dist(p, q) for p, q in zip(valve["papillary_closed"], tips)), 1e-9)
        boundary = (self.folder / "out/scene/scene.json").read_text()
        self.assertIn('"papillary_closed"', boundary)

    def test_what_is_missing_is_named_before_anything_is_looked_for(self):
        opened = self.truth / "phantom/open"
        ring, out = opened / "annulus.mrk.json", self.folder / "out"
        self.assert_bad_input(coapt("close", opened / "image.nrrd", "-o", out), "--annulus")
        none = self.folder / "none.nrrd"
        run = coapt("close", opened / "image.nrrd", "--annulus", ring, "--closed", none, "-o", out)
        self.assert_bad_input(run, "none.nrrd", "does not exist")
        self.assertFalse(out.exists())
        far = marks(self.folder / "far.mrk.json", "ClosedCurve", [turned(p, 0, [500, 0, 0]) for p in positions(ring)])
        self.assert_bad_input(coapt("close", opened / "image.nrrd", "--annulus", far, "-o", out), "outside of the volume", "LPS")
        start = ("close", opened / "image.nrrd", "--annulus", ring, "-o", out)
        self.assert_bad_input(coapt(*start, "--annulus-closed", far), "far.mrk.json", "--register")
        self.assert_bad_input(coapt(*start, "--register"), "--register", "--annulus-closed")
        self.assert_bad_input(coapt(*start, "--closed", self.series()), "beat.seq.nrrd", "2 frames", "--closed-frame, from 0 to 1")
        self.assert_bad_input(coapt(*start, "--closed-frame", 1), "--closed-frame", "needs --closed")
        tips = self.truth / "tips.mrk.json"
        no_ring = ("close", opened / "image.nrrd", "--annulus", tips, "-o", out)
        self.assert_bad_input(coapt(*no_ring), "do not go round it once", "closed curve")
        self.assert_bad_input(coapt(*start, "--papillary-closed", tips), "--papillary-closed", "--papillary,")
        one = marks(self.folder / "one.mrk.json", "Fiducial", [[0, 0, -20]])
        self.assert_bad_input(coapt(*start, "--papillary", tips, "--papillary-closed", one), "one.mrk.json", "1 tips", "same order")
        self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main(argv=[__file__])
