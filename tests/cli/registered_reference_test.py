"""`reference.register` of a scene: the closed surface that a result is compared with, brought onto it."""
import json
import math
import unittest

from command_case import CommandCase, coapt
from register_test import write_landmarks

ANGLE = math.radians(30)
FAR = 5e5  # mm: such a scene is solved about its own middle


def moved(x, y, z):
    return math.cos(ANGLE) * x - math.sin(ANGLE) * z + 6, y - 8, math.sin(ANGLE) * x + math.cos(ANGLE) * z + 1


class RegisteredReference(CommandCase):
    def setUp(self):
        super().setUp()
        self.scene = self.generate("mitral", "--triangles", "300")
        self.out = self.folder / "out"
        run = coapt("solve", self.scene, "-o", self.out, "--no-report")
        self.assertEqual(run.returncode, 0, run.stderr)
        lines = (self.out / "closed.obj").read_text().splitlines()
        self.closed = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
        self.facets = [line for line in lines if line.startswith("f ")]
        self.write_scan(moved)

    def write_scan(self, place):
        points = [place(*p) for p in self.closed]
        (self.folder / "scan.obj").write_text("\n".join(["v %.17g %.17g %.17g" % p for p in points] + self.facets) + "\n")
        for name, of in (("a.mrk.json", self.closed), ("b.mrk.json", points)):
            write_landmarks(self.folder / name, [of[k] for k in (0, 20, 60, 110)])

    def solve(self, *options, **reference):
        keys = json.dumps({"closed_surface": "scan.obj"} | reference)
        path = self.folder / "compared.json"
        path.write_text(self.scene.read_text().replace('"solver":', f'"reference": {keys},\n  "solver":', 1))
        return coapt("solve", path, "-o", self.out, *options)

    def distance(self):
        return json.loads((self.out / "result.json").read_text())["distance_to_reference"]

    def test_every_method_brings_it_back_and_reports_the_motion(self):
        self.assertEqual(self.solve(register="none").returncode, 0)
        as_it_lies = self.distance()
        self.assertGreater(as_it_lies["mean_mm"], 1)
        self.assertNotIn("registration", as_it_lies)
        self.assertGreater(as_it_lies["coaptation_line"]["to_reference"]["mean_mm"], 1)
        self.assertFalse((self.out / "reference.vtp").exists())
        for keys in ({"register": "annulus"}, {"register": "surface", "trim": 0.2, "scale": True},
                     {"register": "landmarks", "landmarks": "a.mrk.json", "reference_landmarks": "b.mrk.json"}):
            with self.subTest(**keys):
                run = self.solve(**keys)
                self.assertEqual(run.returncode, 0, run.stderr)
                self.assertIn("turned by 30 degrees", run.stdout)
                found = self.distance()
                self.assertLess(found["max_mm"], 1e-5)
                for way in ("to_reference", "from_reference"):  # read off a grid
                    self.assertLess(found["coaptation_line"][way]["p95_mm"], 0.05)
                self.assertIn("of coaptation lines", run.stdout)
                registration = found["registration"]
                self.assertEqual(registration["method"], keys["register"])
                self.assertAlmostEqual(registration["angle_deg"], 30, 5)
                for there in ("to_reference", "from_reference"):
                    self.assertEqual(registration[there + "_before"], as_it_lies[there])
                rows, p, q = registration["transform"], moved(*self.closed[7]), self.closed[7]
                for row, wanted in zip(rows, q):
                    self.assertAlmostEqual(sum(a * b for a, b in zip(row, (*p, 1))), wanted, 5)
                self.assertIn("distance_to_result", (self.out / "reference.vtp").read_text(errors="replace"))
                self.assertIn("registered by " + keys["register"], (self.out / "report.html").read_text())

    def test_what_cannot_be_registered_is_compared_as_it_lies_and_says_so(self):
        self.write_scan(lambda x, y, z: moved(-x, y, z))
        run = self.solve(register="landmarks", landmarks="a.mrk.json", reference_landmarks="b.mrk.json")
        self.assertEqual(run.returncode, 2)
        self.assertIn("reference.register: is a mirror image", run.stderr)
        self.write_scan(lambda x, y, z: (0.05 * x, 0.05 * y, 0.05 * z))
        run = self.solve(register="surface")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("reference.closed_surface: is 0.05 times as large", run.stdout)
        self.assertIn("as it lies", run.stdout)
        self.assertNotIn("registration", self.distance())

    def test_far_from_zero_the_transform_acts_on_the_coordinates_of_the_files(self):
        sheet = ["v %.17g %g 0" % (FAR + x, y) for y in range(6) for x in range(6)]
        sheet += ["f %d %d %d\nf %d %d %d" % (a, a + 1, a + 7, a, a + 7, a + 6)
                  for a in (6 * y + x + 1 for y in range(5) for x in range(5))]
        (self.folder / "sheet.obj").write_text("\n".join(sheet) + "\n")
        points = [(FAR + x, y, 0.0) for x, y in ((0, 0), (5, 0), (0, 5))]
        write_landmarks(self.folder / "sheet.mrk.json", points)
        write_landmarks(self.folder / "elsewhere.mrk.json", [(x + 1, y + 2, z + 3) for x, y, z in points])
        (self.folder / "sheet.json").write_text(json.dumps({
            "mesh": {"file": "sheet.obj"},
            "boundary": [{"nodes": {"plane": {"axis": "y", "at": 0}}, "fix": True}],
            "terms": [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "1 mm"}],
            "reference": {"closed_surface": "sheet.obj", "register": "landmarks", "landmarks": "sheet.mrk.json",
                          "reference_landmarks": "elsewhere.mrk.json"}}))
        run = coapt("solve", self.folder / "sheet.json", "-o", self.out)
        self.assertEqual(run.returncode, 0, run.stderr)
        rows = self.distance()["registration"]["transform"]
        for row, wanted in zip(rows, (-1, -2, -3)):
            self.assertAlmostEqual(row[3], wanted, 5)

    def test_a_method_without_its_input_is_refused_before_the_solve(self):
        for keys, words in (({"register": "landmarks"}, "needs the points of both"),
                            ({"register": "annulus", "landmarks": "a.mrk.json"}, "only"),
                            ({"register": "icp"}, "surface"), ({"trim": 0.2}, "only a registration"),
                            ({"register": "none", "scale": True}, "only a registration")):
            run = self.solve(**keys)
            self.assertEqual(run.returncode, 2, run.stdout)
            self.assertIn(words, run.stderr)
        ball = coapt("generate", "sphere", "-o", self.folder / "ball")
        self.assertEqual(ball.returncode, 0, ball.stderr)
        closed = next((self.folder / "ball").glob("*.obj"))
        run = self.solve(register="annulus", closed_surface=str(closed))
        self.assertEqual(run.returncode, 2)
        self.assertIn("reference.register", run.stderr)


if __name__ == "__main__":
    unittest.main(argv=[__file__])
