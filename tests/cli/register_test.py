"""`coapt register`: one surface onto another by each method, and what is refused."""
import json
import math
import unittest

from command_case import CommandCase, coapt

ANGLE = math.radians(30)


def write_sheet(path, place, mirror=1.0, tilt=1.0):
    """A bent sheet of 20 x 20 cells of 2 mm without symmetry; returns its first vertices as placed."""
    lines, points = [], []
    for j in range(21):
        for i in range(21):
            x, y = 2.0 * i - 20, 2.0 * j - 22
            z = tilt * (0.02 * x * x - 0.01 * y * y + 0.0008 * x * x * y + 3 * math.sin(x / 5 + 0.3 * y / 5))
            points.append(place(mirror * x, y, z))
            lines.append("v %.17g %.17g %.17g" % points[-1])
    for j in range(20):
        for i in range(20):
            a = 21 * j + i + 1
            lines += [f"f {a} {a + 1} {a + 22}", f"f {a} {a + 22} {a + 21}"]
    path.write_text("\n".join(lines) + "\n")
    return [points[0], points[20], points[440], points[200]]


def stay(x, y, z):
    return x, y, z


def moved(x, y, z):
    return math.cos(ANGLE) * x - math.sin(ANGLE) * z + 6, y - 8, math.sin(ANGLE) * x + math.cos(ANGLE) * z


def write_landmarks(path, points):
    path.write_text(json.dumps({"markups": [{"type": "Fiducial", "coordinateSystem": "LPS", "controlPoints": [
        {"id": str(k), "position": list(p), "positionStatus": "defined"} for k, p in enumerate(points)]}]}))


class Register(CommandCase):
    def setUp(self):
        super().setUp()
        self.a, self.b, self.out = self.folder / "a.obj", self.folder / "b.obj", self.folder / "out"
        self.marks = self.folder / "a.mrk.json", self.folder / "b.mrk.json"
        write_landmarks(self.marks[0], write_sheet(self.a, moved))
        write_landmarks(self.marks[1], write_sheet(self.b, stay))

    def register(self, *options):
        return coapt("register", self.a, self.b, "-o", self.out, *options)

    def test_every_method_brings_it_back_and_says_so(self):
        for options in ((), ("--method", "annulus"), ("--landmarks", *self.marks), ("--scale",)):
            run = self.register(*options)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertIn("turned by 30 degrees", run.stdout)
            found = json.loads((self.out / "registration.json").read_text())
            self.assertAlmostEqual(found["angle_deg"], 30, 7)
            self.assertAlmostEqual(found["scale"], 1, 9)
            for way in ("to_target", "from_target"):
                self.assertGreater(found["distances_before"][way]["rms_mm"], 1)
                self.assertLess(found["distances_after"][way]["max_mm"], 1e-8)
            for name in ("moved.obj", "moved.vtp", "target.vtp"):
                self.assertTrue((self.out / name).exists())

    def test_what_is_refused_moves_nothing(self):
        write_landmarks(self.marks[1], [(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 0, 0)])
        self.assert_bad_input(self.register("--landmarks", *self.marks), "b.mrk.json", "one line")
        write_landmarks(self.marks[1], [(0, 0, 0), (1, 0, 0)])
        self.assert_bad_input(self.register("--landmarks", *self.marks), "landmarks, but 2")
        self.assert_bad_input(self.register("--method", "landmarks"), "--landmarks")
        write_sheet(self.a, moved, mirror=-1.0)
        self.assert_bad_input(self.register(), "a.obj", "mirror image", "Nothing was moved")
        self.assert_bad_input(self.register("--method", "annulus"), "a.obj", "mirror image")
        self.a.write_text("v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        self.assert_bad_input(self.register("--method", "annulus"), "a.obj", "no closed boundary loop")
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main(argv=[__file__])
