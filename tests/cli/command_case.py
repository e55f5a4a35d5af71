"""What the tests of the command share: each has a scratch folder and runs the command given as first argument."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

COAPT = os.path.abspath(sys.argv[1])
FILES = {"result.json", "closed.vtp", "closed.obj", "trace.csv", "metrics.csv", "report.html"}  # of a result with a surface


def coapt(*arguments, cwd=None, timeout=120, keeps_progress=False):
    """The command; without the lines of progress that a log gets every five seconds, unless they are wanted."""
    run = subprocess.run([COAPT, *map(str, arguments)], capture_output=True, text=True, cwd=cwd, timeout=timeout)
    if not keeps_progress:
        run.stderr = re.sub(r"(?m)^  ((mesh \d+ of \d+, |finest mesh, )?step \d+, |\d+ of \d+ points, |certificate, |sliders of the page, )[^\n]* s[^\n]*\n", "", run.stderr)
    return run


def content_of(scene):
    """What a generated scene holds; its comments are for people."""
    return json.loads(re.sub(r"(?m)(^|[\s{])//[^\n]*$", r"\1", scene.read_text()))


class CommandCase(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)

    def generate(self, shape, *options):
        if shape == "mitral" and not {"--rough", "--preset"} & set(options):
            options = (*options, "--preset", "benchmark")  # what a test says of figures was made on it
        run = coapt("generate", shape, "-o", self.folder, *options)
        self.assertEqual(run.returncode, 0, run.stderr)
        return self.folder / "scene.json"

    def strips(self):
        """A scene of twelve strips pushed together in their plane: more saddles than one run leaves, if it ends beside each,
        as lbfgs does with a tolerance of 0.1."""
        points, triangles, held, pushed = [], [], [], []
        for strip in range(12):
            first = len(points)
            points += [((10 + strip) * i / 12, 3 * strip + j, 0) for i in range(13) for j in (0, 1)]
            for a in range(first, first + 24, 2):
                triangles += [(a, a + 2, a + 1), (a + 1, a + 2, a + 3)]
            held += range(first, first + 4)
            pushed += range(first + 22, first + 26)
        (self.folder / "strips.obj").write_text("".join(f"v {x:.9g} {y} {z}\n" for x, y, z in points) + "".join(
            f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles))
        scene = self.folder / "scene.json"
        sheet = {"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"}
        scene.write_text(json.dumps({
            "mesh": {"file": "strips.obj"}, "terms": [sheet, {"type": "bending"}],
            "boundary": [{"nodes": held, "fix": True}, {"nodes": pushed, "move_to": {"translate": [-0.1, 0, 0]}}]}))
        return scene

    def result(self, folder=None):
        text = ((folder or self.folder / "result") / "result.json").read_text()
        self.assertNotIn("NaN", text)
        return json.loads(text)

    def assert_bad_input(self, run, *pieces):
        self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
        for line in run.stderr.splitlines():
            self.assertTrue(line.startswith("coapt: error: "), line)
        for piece in pieces:
            self.assertIn(piece, run.stderr)
