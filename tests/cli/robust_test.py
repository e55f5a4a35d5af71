"""Nothing breaks: runaway shapes, extreme numbers, limits of memory and of the disk, inputs that are no files.

Usage: robust_test.py COAPT_BINARY [unittest arguments]
"""
import json
import os
import pathlib
import re
import resource
import subprocess
import unittest

from command_case import COAPT, CommandCase, coapt, content_of


def limited(limit, amount, *arguments, timeout=120):
    """The command under a limit of a resource."""
    return subprocess.run([COAPT, *map(str, arguments)], capture_output=True, text=True, timeout=timeout,
                          preexec_fn=lambda: resource.setrlimit(limit, (amount, amount)))


class Robust(CommandCase):
    def edited(self, scene, change):
        content = content_of(scene)
        change(content)
        scene.write_text(json.dumps(content))
        return scene

    def test_a_valve_that_runs_away_ends_with_a_result(self):
        scene = self.generate("mitral", "--triangles", 200)

        def soften(content):
            content["terms"] = [term for term in content["terms"] if not term["type"].startswith("contact")]
            for term in content["terms"]:
                if term["type"] == "cst_tension_field":
                    for key in ("young", "poisson"):
                        term.pop(key, None)
                    term.update({"type": "cst_neo_hookean", "shear_modulus": "0.1 MPa"})
                if term["type"] == "load_pressure":
                    term["value"] = "300 mmHg"

        run = coapt("solve", self.edited(scene, soften), "--max-seconds", 20)
        self.assertIn(run.returncode, [0, 1, 4], run.stdout + run.stderr)
        self.assertNotIn("nan", (run.stdout + run.stderr).lower())
        self.result()

    def test_no_number_is_printed_as_nan(self):
        for value in ["1e308 MPa", "1e-300 MPa", "1e150 MPa"]:
            scene = self.generate("disc", "--triangles", 100)
            text = scene.read_text()
            scene.write_text(re.sub(r'"young": "[^"]*"', f'"young": "{value}"', text))
            self.assertNotEqual(scene.read_text(), text)
            run = coapt("solve", scene, "--max-seconds", 10)
            self.assertIn(run.returncode, [0, 1, 2, 4], run.stdout + run.stderr)
            self.assertNotRegex(run.stdout + run.stderr, r"(?i)\bnan\b", value)

    def test_numbers_beyond_arithmetic_are_refused_and_others_leave_no_infinity(self):
        def values(node, path=()):
            for key, value in node.items() if isinstance(node, dict) else enumerate(node):
                if isinstance(value, (dict, list)):
                    yield from values(value, (*path, key))
                elif isinstance(value, str) and re.fullmatch(r"[\d.]+ [A-Za-z/]+", value):
                    yield (*path, key), value.split()[1]

        for shape in ["disc", "tent", "airbag", "mitral"]:
            scene = self.generate(shape, "--triangles", 60 if shape != "mitral" else 150)
            content = content_of(scene)
            for path, unit in values({"terms": content["terms"]}):
                for number in ["1e308", "1e49", "1e-300"]:
                    changed = json.loads(json.dumps(content))
                    place = changed
                    for key in path[:-1]:
                        place = place[key]
                    place[path[-1]] = f"{number} {unit}"
                    scene.write_text(json.dumps(changed))
                    run = coapt("solve", scene, "--max-seconds", 2, "--no-report")
                    with self.subTest(shape=shape, path=path, number=number):
                        self.assertNotRegex(run.stdout + run.stderr, r"(?i)\b(nan|inf)\b")
                        if number == "1e308":
                            self.assert_bad_input(run, path[-1])
                            self.assertRegex(run.stderr, "is beyond 1e50 .* is its unit right|the number is out of range")
                        else:
                            self.assertIn(run.returncode, [0, 1, 2, 4], run.stdout + run.stderr)

    def test_a_motion_that_nothing_can_follow_is_named_with_its_share_and_a_remedy(self):
        scene = self.generate("square", "--triangles", 60)
        content = content_of(scene)
        content["terms"][0] = {"type": "cst_exponential", "c0": "1 kPa", "c1": "1 kPa", "c2": 1000, "thickness": "1 mm"}
        content["boundary"].append({"nodes": [0], "move_to": {"translate": [-1e6, 0, 0]}})
        scene.write_text(json.dumps(content))
        for options in [], ["--damped-steps", "5"]:
            run = coapt("solve", scene, *options, "--max-seconds", 20)
            self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
            said = run.stdout.splitlines()[0]
            self.assertRegex(said, r"the prescribed motion of .*boundary\[1\].* at \S+ % of it; end it before, ")
            self.assertNotRegex(run.stdout + run.stderr, r"(?i)\b(nan|inf)\b")

    def test_too_little_memory_is_said_and_ends_the_run(self):
        scene = self.generate("mitral", "--triangles", 20000)
        # Libraries end the process themselves, before main, where they are not even loaded.
        least = next(megabytes for megabytes in range(96, 400, 2)
                     if limited(resource.RLIMIT_AS, megabytes << 20, "--version").returncode == 0)
        for megabytes in [least, least + 50, least + 200]:
            run = limited(resource.RLIMIT_AS, megabytes << 20, "solve", scene, "--max-seconds", 5)
            self.assertIn(run.returncode, [0, 1, 3, 4], f"{megabytes} MB: {run.stdout}{run.stderr}")
            if run.returncode == 3:
                self.assertIn("not enough memory", run.stderr)

    def test_a_thread_of_blas_that_waits_for_memory_keeps_no_process_alive(self):
        scene = self.generate("disc", "--triangles", 100)
        reached_main = 0
        for megabytes in range(96, 400, 16):
            run = limited(resource.RLIMIT_AS, megabytes << 20, "solve", scene, timeout=60)
            # Libraries may end the process themselves, before main: then it does not even say its version.
            if limited(resource.RLIMIT_AS, megabytes << 20, "--version", timeout=60).returncode != 0:
                continue
            reached_main += 1
            if "OpenBLAS blas_thread_init" in run.stderr:
                continue
            self.assertIn(run.returncode, [0, 3, 127], f"{megabytes} MB: {run.stdout}{run.stderr}")
        self.assertGreater(reached_main, 0)

    def test_pipes_devices_and_folders_are_named_as_such(self):
        scene = self.generate("mitral", "--triangles", 300)
        pipe = self.folder / "x.obj"  # a name that does not say what it is
        os.mkfifo(pipe)
        for path, what in [(pipe, "pipe"), ("/dev/zero", "device"), (self.folder, "folder")]:
            for arguments in [["solve", path], ["check", path], ["import", path, "-o", self.folder / "new"],
                              ["export", path, "-o", self.folder / "x.feb"], ["register", path, path],
                              ["solve", scene, "--resume", path], ["solve", scene, "--checkpoint", path],
                              ["compare", scene, "--closed", path], ["tune", scene, "--target", path],
                              ["generate", "mitral", "--annulus", path, "-o", self.folder / "new"]]:
                with self.subTest(arguments):
                    self.assert_bad_input(coapt(*arguments, timeout=20), f"is a {what}")
        self.assertEqual([file.name for file in pathlib.Path("/dev").iterdir() if file.name.startswith("zero.")], [])
        for place, key in [("mesh", "file"), ("mesh", "sets"), ("reference", "closed_surface")]:
            changed = self.folder / "changed.json"
            content = content_of(scene)
            content.setdefault(place, {})[key] = "x.obj"
            changed.write_text(json.dumps(content))
            self.assert_bad_input(coapt("solve", changed, timeout=20), f"{place}.{key}: ", "is a pipe")
            self.assert_bad_input(coapt("check", changed, timeout=20), f"{place}.{key}: ", "is a pipe")

    def test_twenty_thousand_terms_are_read_in_seconds(self):
        scene = self.generate("disc", "--triangles", 100)
        force = {"type": "load_field", "force": "1e-9 N", "direction": [0, 0, 1], "nodes": [1]}
        self.edited(scene, lambda content: content["terms"].extend([force] * 20000))
        begun = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        run = coapt("export", scene, "-o", self.folder / "out.obj")
        used = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - begun
        self.assertEqual(run.returncode, 0, (run.stdout + run.stderr)[-600:])
        self.assertLess(used, 5)

    def test_a_scene_does_not_choose_a_folder_outside(self):
        scene = self.generate("disc", "--triangles", 100)
        outside = self.folder.parent / (self.folder.name + "_outside")
        for folder in [str(outside), "../" + outside.name]:
            self.edited(scene, lambda content: content.update(output={"folder": folder}))
            for command in ["solve", "sensitivity", "mesh-study", "compare", "bench"]:
                self.assert_bad_input(coapt(command, scene), "output.folder", "-o")
        self.assertFalse(outside.exists())
        (self.folder / "link").symlink_to(self.folder.parent)
        self.edited(scene, lambda content: content.update(output={"folder": "link/" + outside.name}))
        self.assert_bad_input(coapt("solve", scene), "output.folder")
        self.edited(scene, lambda content: content.update(output={"folder": "inside/deep"}))
        self.assertEqual(coapt("solve", scene).returncode, 0)
        self.assertTrue((self.folder / "inside" / "deep" / "result.json").exists())

    def test_a_scene_called_by_its_bare_name_has_its_folder_for_results(self):
        scene = self.generate("disc", "--triangles", 100)
        self.edited(scene, lambda content: content.update(output={"folder": "own"}))
        for command in ["solve", "mesh-study", "sensitivity", "compare"]:
            options = ["--levels", 1] if command == "mesh-study" else []
            run = coapt(command, scene.name, *options, cwd=self.folder)
            self.assertIn(run.returncode, [0, 1, 4], command + ": " + run.stdout + run.stderr)
        self.assertTrue((self.folder / "own" / "result.json").exists())
        self.edited(scene, lambda content: content.update(output={"folder": "../outside"}))
        self.assert_bad_input(coapt("solve", scene.name, cwd=self.folder), "output.folder", "-o")


if __name__ == "__main__":
    unittest.main(argv=[__file__])
