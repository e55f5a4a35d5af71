"""Kills and interrupts the real command at random moments, takes its runs up again and compares (S17).

Usage: resume_test.py COAPT_BINARY [unittest arguments]
"""
import csv
import json
import os
import random
import resource
import signal
import subprocess
import sys
import time
import unittest
from xml.etree import ElementTree

from command_case import COAPT, CommandCase, coapt

TIGHT = ["--tolerance", "1e-10"]


def vertices(path):
    return [[float(x) for x in line.split()[1:4]] for line in path.read_text().splitlines() if line.startswith("v ")]


def read_vtp(path):
    """The part before the appended data, as XML; the whole of a file that has none."""
    head = path.read_bytes().split(b"<AppendedData")[0]
    ElementTree.fromstring(head + (b"" if head.rstrip().endswith(b"</VTKFile>") else b"</VTKFile>"))


READERS = {".json": lambda path: json.loads(path.read_text()),
           ".csv": lambda path: list(csv.DictReader(path.read_text().splitlines())),
           ".obj": vertices, ".vtp": read_vtp, ".pvd": lambda path: ElementTree.parse(path)}


class ResumeTest(CommandCase):
    def setUp(self):
        super().setUp()
        self.moments = random.Random(17)
        self.kept = self.folder / "run.checkpoint"

    def solve(self, scene, *options, name="result"):
        return coapt("solve", scene, "-o", self.folder / name, *options)

    def stopped(self, scene, number, seconds, *options):
        """The exit code of a solve that got this signal after so many seconds."""
        process = subprocess.Popen([COAPT, "solve", str(scene), "-o", str(self.folder / "cut"), *map(str, options)],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        self.addCleanup(process.kill)
        time.sleep(seconds)
        process.send_signal(number)
        output = process.communicate(timeout=100)
        self.assertIn(process.returncode, [0, 1, -number], output)
        return process.returncode

    def assert_whole(self, folder):
        """Every file is whole, or of a name that says it is not."""
        for path in folder.rglob("*") if folder.exists() else []:
            if path.is_dir() or ".part" in path.name or path.name == ".coapt.lock":
                continue
            if path.suffix == ".html":
                self.assertTrue(path.read_text().endswith("</html>\n"), path)
            else:
                self.assertIn(path.suffix, READERS, path)
                READERS[path.suffix](path)
        if (folder / "result.json").exists():
            for name in json.loads((folder / "result.json").read_text())["files"]:
                self.assertTrue((folder / name).exists(), name)

    def assert_same_shape(self, name, reference="result"):
        """Every vertex within 1e-9 of the extent of where it is in the reference."""
        own, other = (vertices(self.folder / folder / "closed.obj") for folder in [name, reference])
        extent = max(max(axis) - min(axis) for axis in zip(*other))
        farthest = max(abs(a - b) for p, q in zip(own, other) for a, b in zip(p, q))
        self.assertLessEqual(farthest, 1e-9 * extent)

    def wall_seconds(self, scene, *options):
        begun = time.monotonic()
        run = self.solve(scene, *options)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return time.monotonic() - begun

    def test_killed_or_interrupted_at_any_moment_it_goes_on_to_the_same_result(self):
        scene = self.generate("mitral", "--triangles", 300)
        scene.write_text(scene.read_text().replace('"boundary":', '"motion": {"steps": 4}, "boundary":', 1))
        whole = self.wall_seconds(scene, *TIGHT)
        cuts, resumed = 0, 0
        for number in [signal.SIGKILL, signal.SIGINT, signal.SIGTERM] * 4:
            with self.subTest(signal=number, cut=cuts):
                known = ["--resume", self.kept] if self.kept.exists() else ["--checkpoint", self.kept]
                code = self.stopped(scene, number, self.moments.uniform(0, 0.9 * whole), *known, "--checkpoint-every",
                                    0.001, *TIGHT)
                self.assert_whole(self.folder / "cut")
                cuts += code != 0
                resumed += known[0] == "--resume"
                if code != 0 and not self.kept.exists():
                    continue  # before it had begun
                if number == signal.SIGTERM and self.kept.exists():
                    run = self.solve(scene, "--resume", self.kept, *TIGHT, name="resumed")
                    self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
                if code == 0:
                    self.assert_same_shape("cut")
                elif not self.kept.exists():
                    self.assert_same_shape("resumed")
        self.assertGreater(cuts, 1)
        self.assertGreater(resumed, 0)
        self.assertFalse(self.kept.exists(), "removed when the run is through")

    def limited_to(self, limit, scene, *options):
        """The exit code of a solve none of whose files may be longer than this, and the files whose parts it left behind,
        by the names that they were to have."""
        run = subprocess.run([COAPT, "solve", str(scene), "-o", str(self.folder / "cut"), *map(str, options)],
                             capture_output=True, text=True, timeout=100,
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
        parts = list(self.folder.rglob("*.part-*"))
        for part in parts:
            self.assertLessEqual(part.stat().st_size, limit)
            part.unlink()
        return run.returncode, {part.name.split(".part-")[0] for part in parts}

    def test_a_file_that_cannot_be_written_leaves_the_earlier_one_whole(self):
        scene = self.generate("mitral", "--triangles", 300)
        self.wall_seconds(scene)
        sizes = {path.stat().st_size for path in (self.folder / "result").iterdir()}
        self.solve(scene, "--tolerance", "1e-2", name="cut")
        names = {path.name for path in (self.folder / "cut").iterdir()}
        struck = set()
        for limit in sorted({1} | {size // 2 for size in sizes} | {size * 9 // 10 for size in sizes}):
            with self.subTest(limit=limit):
                earlier = {name: (self.folder / "cut" / name).read_bytes() for name in names}
                code, files = self.limited_to(limit, scene)
                self.assertEqual((code, files), (5, set()))
                self.assert_whole(self.folder / "cut")
                for name in names:
                    now = (self.folder / "cut" / name).read_bytes()
                    if len(now) > limit:
                        self.assertEqual(now, earlier[name], name)
                        struck.add(name)
        self.assertLessEqual({"result.json", "trace.csv", "closed.vtp", "report.html"}, struck)
        code, _ = self.limited_to(1000, scene, "--checkpoint", self.kept, "--checkpoint-every", 1e-6)
        self.assertEqual(code, 5)
        self.assertLess(self.kept.stat().st_size, 1000, "an earlier checkpoint, whole")
        self.wall_seconds(scene, "--resume", self.kept)

    def killed_among_files(self, count, scene):
        """The exit code of a solve that is killed as soon as so many of its files have begun to be written."""
        process = subprocess.Popen([COAPT, "solve", str(scene), "-o", str(self.folder / "cut")],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        seen = set()
        while len(seen) < count and process.poll() is None:
            seen |= {entry.name for entry in os.scandir(self.folder / "cut") if ".part-" in entry.name}
        process.kill()
        return process.wait()

    def test_killed_between_two_files_each_is_whole(self):
        scene = self.generate("mitral", "--triangles", 300)
        self.solve(scene, "--tolerance", "1e-2", name="cut")
        killed = 0
        for count in [1, 2, 3, 4] * 3:
            killed += self.killed_among_files(count, scene) == -signal.SIGKILL
            self.assert_whole(self.folder / "cut")
            for part in self.folder.rglob("*.part-*"):
                part.unlink()
        self.assertGreater(killed, 0)

    def cut_by_time(self, scene, *options):
        """Solves the whole, then a part of it to a checkpoint. False where the solver is not in this build."""
        run = self.solve(scene, *options)
        if "is not known" in run.stderr:
            return False
        whole = self.result()["time"]["wall_s"]
        for share in [0.3, 0.1, 0.03, 1e-6]:  # a busy machine measures times that it then needs no more
            run = self.solve(scene, *options, "--max-seconds", share * whole, "--checkpoint", self.kept, name="cut")
            if self.kept.exists():
                break
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        self.assertIn("--resume", run.stdout)
        self.assertEqual(self.result(self.folder / "cut")["status"], "time_limit")
        return True

    def test_goes_on_after_a_limit_of_time(self):
        scene = self.generate("disc", "--triangles", 500)
        for solver in ["newton", "lbfgs", "dynamic", "ceres", "nlopt"]:
            with self.subTest(solver):
                # From some cuts Ceres comes no nearer than 1.4e-10: the differences of its energy are round-off.
                options = [*(["--tolerance", "1e-9"] if solver == "ceres" else TIGHT), "--solver", solver]
                if not self.cut_by_time(scene, *options):
                    continue
                run = self.solve(scene, *options, "--resume", self.kept, name="cut")
                self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
                self.assert_same_shape("cut")
                self.assertFalse(self.kept.exists())

    def assert_same_bytes(self):
        shapes = [(self.folder / name / "closed.obj").read_bytes() for name in ["cut", "result"]]
        self.assertEqual(shapes[0], shapes[1])

    def test_resumed_exactly_it_finds_the_same_of_many_equilibria(self):
        scene = self.generate("airbag", "--triangles", 300)
        self.cut_by_time(scene, *TIGHT)
        run = self.solve(scene, *TIGHT, "--resume", self.kept, "--exactly", name="cut")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assert_same_bytes()

    def test_resumed_exactly_it_eliminates_in_the_order_that_was_left(self):
        scene = self.generate("mitral", "--triangles", 300, "--seed", 3)
        self.solve(scene, *TIGHT)
        whole = self.result()["time"]["wall_s"]
        cut = 0
        for share in [0.9, 0.75, 0.6, 0.45, 0.3, 0.1, 0.03]:  # a busy machine measures times that it then needs no more
            self.kept.unlink(missing_ok=True)
            self.solve(scene, *TIGHT, "--max-seconds", share * whole, "--checkpoint", self.kept, name="cut")
            if self.kept.exists():
                cut += 1
                run = self.solve(scene, *TIGHT, "--resume", self.kept, "--exactly", name="cut")
                self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
                self.assert_same_bytes()
            if cut == 4:
                break
        self.assertGreater(cut, 0)

    def test_what_velocities_decide_is_begun_anew(self):
        scene = self.generate("disc", "--triangles", 100)
        self.cut_by_time(scene, "--solver", "xpbd")
        self.solve(scene, "--solver", "xpbd", "--resume", self.kept, name="cut")
        self.assert_same_bytes()

    def test_says_what_to_do_with_a_checkpoint_that_does_not_fit(self):
        scene = self.generate("disc", "--triangles", 100)
        run = self.solve(scene, "--max-seconds", 1e-9, "--checkpoint", self.kept)
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        bytes_kept = self.kept.read_bytes()
        self.assert_bad_input(self.solve(scene, "--checkpoint", self.kept), "run.checkpoint", "--resume", "remove")
        self.assert_bad_input(self.solve(scene, "--resume", self.kept, "--solver", "lbfgs", "--tolerance", "1e-7"),
                              "newton", "--solver", "--tolerance")
        self.assert_bad_input(self.solve(scene, "--resume", self.kept, "--damped-steps", 20), "--damped-steps")
        text = scene.read_text()
        scene.write_text(text.replace('"poisson"', '"poisson" '))
        self.assertEqual(self.solve(scene, "--resume", self.kept, "--max-seconds", 1e-9).returncode, 1, "only spaces")
        mesh = next(self.folder.glob("*.obj"))
        mesh.write_text(mesh.read_text() + "# changed\n")
        self.assert_bad_input(self.solve(scene, "--resume", self.kept), "another scene", "without --resume")
        self.kept.write_bytes(bytes_kept[:-1])
        self.assert_bad_input(self.solve(scene, "--resume", self.kept), "damaged")
        self.assert_bad_input(self.solve(scene, "--resume", self.folder / "none"), "none", "no such file")
        self.assert_bad_input(self.solve(scene, "--checkpoint", self.folder / "no" / "file"), "folder")
        self.assert_bad_input(self.solve(scene, "--checkpoint", self.folder / "x", "--solver", "nwton"), "nwton")
        self.assertFalse((self.folder / "x").exists(), "nothing is left of a run that never began")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
