"""Where commands write: one process at a time, nothing of another's replaced, nothing lost on a full disk.

Usage: output_test.py COAPT_BINARY [unittest arguments]
"""
import fcntl
import json
import re
import resource
import signal
import subprocess
import time
import unittest

from command_case import COAPT, CommandCase, coapt, content_of


class Output(CommandCase):
    def limited(self, size, *arguments):
        return subprocess.run([COAPT, *map(str, arguments)], capture_output=True, text=True, timeout=120,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size)))

    def test_one_process_at_a_time_writes_into_a_folder(self):
        scene, out = self.generate("disc", "--triangles", 100), self.folder / "out"
        out.mkdir()
        with open(out / ".coapt.lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            for command in ["solve", "sensitivity", "mesh-study", "compare", "bench", "intervene", "stress"]:
                self.assert_bad_input(coapt(command, scene, "-o", out), str(out), "another process")
            self.assert_bad_input(coapt("generate", "disc", "-o", out), "another process")
            self.assertEqual([path.name for path in out.iterdir()], [".coapt.lock"])
        run = coapt("solve", scene, "-o", out)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertFalse((out / ".coapt.lock").exists())

    def test_a_killed_process_locks_nothing(self):
        scene, out = self.generate("mitral", "--triangles", 20000), self.folder / "out"
        process = subprocess.Popen([COAPT, "solve", str(scene), "-o", str(out)], stdout=subprocess.DEVNULL)
        self.addCleanup(process.kill)
        while not (out / ".coapt.lock").exists() and process.poll() is None:
            time.sleep(0.01)
        self.assert_bad_input(coapt("solve", scene, "-o", out), "another process")
        process.send_signal(signal.SIGKILL)
        process.wait()
        run = coapt("solve", scene, "-o", out, "--max-seconds", 0.1)
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)

    def test_one_process_at_a_time_keeps_its_run_in_a_checkpoint(self):
        scene, kept = self.generate("disc", "--triangles", 100), self.folder / "run.checkpoint"
        with open(str(kept) + ".lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            self.assert_bad_input(coapt("solve", scene, "--checkpoint", kept), "run.checkpoint", "another process")
        run = coapt("solve", scene, "--checkpoint", kept)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertEqual(list(self.folder.glob("run.checkpoint*")), [])

    def test_a_refused_run_leaves_no_folder(self):
        scene, out = self.generate("disc", "--triangles", 100), self.folder / "new" / "out"
        self.assert_bad_input(coapt("solve", scene, "-o", out, "--solver", "nwton"), "nwton")
        self.assertFalse((self.folder / "new").exists())

    def test_no_input_is_replaced_by_a_result(self):
        scene, out = self.generate("disc", "--triangles", 100), self.folder / "out"
        out.mkdir()
        content = content_of(scene)
        mesh = self.folder / content["mesh"]["file"]
        for name, command in [("closed.obj", "solve"), ("closed_400.obj", "mesh-study")]:
            (out / name).write_bytes(mesh.read_bytes())
            content["mesh"]["file"] = "out/" + name
            scene.write_text(json.dumps(content))
            self.assert_bad_input(coapt(command, scene, "-o", out), name, "-o")
            self.assertEqual((out / name).read_bytes(), mesh.read_bytes())
        content["mesh"]["file"] = mesh.name
        named = self.folder / "result.json"
        named.write_text(json.dumps(content))
        self.assert_bad_input(coapt("solve", named, "-o", self.folder), "result.json")
        self.assertEqual(json.loads(named.read_text()), content)

    def test_no_command_replaces_a_file_that_it_reads(self):
        scene = self.generate("mitral", "--triangles", 250)
        edits = self.folder / "intervene.json"
        edits.write_text(json.dumps({"type": "ring", "size": "95 %"}))
        (self.folder / "alias.obj").symlink_to("leaflets.obj")
        before = {path.name: path.read_bytes() for path in self.folder.iterdir()}
        for name in ["leaflets.obj", "alias.obj", "scene.json"]:
            self.assert_bad_input(coapt("export", scene, "-o", self.folder / name), name, "write to another")
        self.assert_bad_input(coapt("export", scene.name, "-o", "leaflets.obj", cwd=self.folder), "leaflets.obj")
        self.assert_bad_input(coapt("intervene", scene, "--edits", edits, "-o", self.folder), "intervene.json", "-o")
        target = self.folder / "tuned.json"
        target.write_bytes(before["valve.json"])
        self.assert_bad_input(coapt("tune", scene, "--target", target, "-o", self.folder), "tuned.json", "-o")
        target.unlink()
        self.assertEqual({path.name: path.read_bytes() for path in self.folder.iterdir()}, before)
        self.assertEqual(coapt("export", scene, "-o", self.folder / "new.obj").returncode, 0)

    def test_generate_says_what_it_replaces(self):
        scene = self.generate("disc", "--triangles", 100)
        scene.write_text(scene.read_text() + "// mine\n")
        run = coapt("generate", "disc", "--triangles", 100, "-o", self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stderr, f"coapt: warning: {scene}: was there with other content, and is replaced\n")
        again = coapt("generate", "disc", "--triangles", 100, "-o", self.folder, "--json")
        self.assertEqual((again.stderr, json.loads(again.stdout)["warnings"]), ("", []))
        other = json.loads(coapt("generate", "disc", "--triangles", 200, "-o", self.folder, "--json").stdout)
        self.assertEqual(len(other["warnings"]), 1, other)
        self.assertIn("mesh.obj", other["warnings"][0])

    def test_analyses_share_a_folder(self):
        scene, out = self.generate("mitral", "--triangles", 250), self.folder / "out"
        self.assertIn(coapt("solve", scene, "-o", out).returncode, [0, 4])
        before = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
        edit = json.dumps({"type": "ring", "size": "95 %"})
        for arguments in [["compare", scene, "--methods", "newton,lbfgs"], ["bench", scene, "--levels", 0, "--repeats", 1,
                          "--tolerances", "1e-2,1e-4", "--methods", "newton"],
                          ["tune", scene, "--orifice-weight", 1, "--by", "all", "--max-solves", 2],
                          ["intervene", scene, "--edit", edit], ["sensitivity", scene, "--parameters", "chords.young"]]:
            run = coapt(*arguments, "-o", out)
            self.assertIn(run.returncode, [0, 1, 2], run.stdout + run.stderr)
            for path, content in before.items():
                self.assertEqual(path.read_bytes(), content, f"{arguments[0]} replaced {path.name}")
            before.update({path: path.read_bytes() for path in out.rglob("*") if path.is_file()})

    def test_a_full_disk_loses_nothing_that_was_computed(self):
        scene, out = self.generate("mitral", "--triangles", 2500), self.folder / "out"
        kept = self.folder / "run.checkpoint"
        run = self.limited(40000, "solve", scene, "-o", out)
        self.assertEqual(run.returncode, 5, run.stdout + run.stderr)
        self.assertIn("is the disk full?", run.stderr)
        self.assertIn("closed.vtp", run.stderr)
        self.assertIn("residual", run.stdout)
        said = re.search(r"(?m)^written to .* \((.*)\)$", run.stdout)[1].split(", ")
        self.assertIn("result.json", said)
        self.assertEqual([name for name in said if not (out / name).exists()], [])
        written = json.loads((out / "result.json").read_text())
        self.assertIn(written["status"], ["converged", "stalled"])
        self.assertEqual([path.name for path in out.iterdir() if ".part" in path.name], [])
        shown = self.limited(0, "solve", scene, "-o", out, "--json")
        self.assertEqual(shown.returncode, 5, shown.stderr)
        self.assertEqual(json.loads(shown.stdout)["energy_mj"], written["energy_mj"])
        self.assertEqual(json.loads((out / "result.json").read_text()), written, "the earlier one stays whole")

    def test_a_frame_that_is_lost_ends_no_run(self):
        scene, out = self.generate("mitral", "--triangles", 2500), self.folder / "out"
        run = self.limited(40000, "solve", scene, "-o", out, "--frames", 1)
        self.assertEqual(run.returncode, 5, run.stdout + run.stderr)
        self.assertIn("frame_", run.stderr)
        self.assertGreater(json.loads((out / "result.json").read_text())["iterations"], 1)


if __name__ == "__main__":
    unittest.main(argv=[__file__])
