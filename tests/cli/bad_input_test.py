"""Bad scenes and bad meshes: the command refuses each with exit code 2, says where and why, and writes nothing.

Usage: bad_input_test.py COAPT_BINARY [FOLDER_OF_BAD_MESHES] [unittest arguments]
The folder holds meshes and `expected.json` with the verdict that each must get.
"""
import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

COAPT = os.path.abspath(sys.argv[1])
MESHES = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None

SQUARE = "".join(f"v {i} {j} 0\n" for j in range(4) for i in range(4)) + "".join(
    f"f {k} {k + 1} {k + 5}\nf {k} {k + 5} {k + 4}\n" for k in (1, 2, 3, 5, 6, 7, 9, 10, 11))
SCENE = {
    "mesh": {"file": "mesh.obj"},
    "boundary": [{"nodes": "boundary", "fix": True}],
    "terms": [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"},
              {"type": "load_pressure", "value": "0.1 kPa"}],
    "solver": {"type": "lbfgs", "tolerance": 1e-6},
}
CHORD = {"from": {"papillary": 0}, "to": {"leaflet": 5}, "rest_length": 1, "area": 0.4}


def network(**changes):
    return json.dumps({"units": "mm", "papillary": [[0, 0, -1]], "junctions": [], "chords": [{**CHORD, **changes}]})


FILES = {
    "far.json": network(to={"leaflet": 9999}),
    "negative.json": network(rest_length=-1),
    "loop.json": network(to={"papillary": 0}),
    "list.json": "[]",
    "short.csv": "0,0,0\n",
    "mesh.xyz": SQUARE,
}
DROP = object()


def changed(*steps):
    """SCENE with values set at paths, such as (("terms", 0, "young"), "1 kg"); DROP removes the key."""
    scene = copy.deepcopy(SCENE)
    for path, value in steps:
        place = scene
        for key in path[:-1]:
            place = place[key]
        if value is DROP:
            del place[path[-1]]
        elif isinstance(place, list) and path[-1] == len(place):
            place.append(value)
        else:
            place[path[-1]] = value
    return json.dumps(scene)


def chords(file):
    return changed((("terms", 2), {"type": "cable", "young": "1 MPa", "network": file}))


def membrane(key, value):
    return changed((("terms", 0, key), value))


def extra(**term):
    return changed((("terms", 2), term))


PLAIN = changed()

# name: (the file's content, what the message must contain). Refused before the mesh is read.
BAD_SCENES = {
    "unknown key": (changed((("meshh",), 1)), ["meshh", 'did you mean "mesh"']),
    "unknown key of a term": (membrane("thicknes", 1), ["terms[0].thicknes", "thickness"]),
    "unknown key of the solver": (changed((("solver", "tolerence"), 1)), ["solver.tolerence", "tolerance"]),
    "unknown term": (membrane("type", "cst_stkv"), ["terms[0].type", "cst_stkv", "cst_stvk"]),
    "term without type": (membrane("type", DROP), ["terms[0].type", "missing"]),
    "term that is no object": (changed((("terms", 0), "x")), ["terms[0]"]),
    "no terms": (changed((("terms",), [])), ["terms", "empty"]),
    "terms of a wrong type": (changed((("terms",), {})), ["terms", "list"]),
    "no unit": (membrane("young", "1"), ["terms[0].young", "unit", "pressure"]),
    "bare number": (membrane("young", 1), ["terms[0].young", "unit"]),
    "wrong unit": (membrane("young", "1 kg"), ["terms[0].young", "1 kg", "mass"]),
    "unknown unit": (membrane("young", "1 parsnip"), ["terms[0].young", "parsnip"]),
    "pressure for a length": (membrane("thickness", "1 MPa"), ["terms[0].thickness", "pressure"]),
    "null": (membrane("young", None), ["terms[0].young", "null"]),
    "truth value": (membrane("young", True), ["terms[0].young", "true"]),
    "negative stiffness": (membrane("young", "-1 MPa"), ["terms[0].young", "-1 MPa"]),
    "not-a-number in a quantity": (membrane("young", "nan MPa"), ["terms[0].young", "finite"]),
    "infinite quantity": (membrane("young", "inf MPa"), ["terms[0].young", "finite"]),
    "overflowing quantity": (membrane("young", "1e400 MPa"), ["terms[0].young", "range"]),
    "negative thickness": (membrane("thickness", "-0.1 mm"), ["terms[0].thickness", "-0.1 mm"]),
    "zero thickness": (membrane("thickness", 0), ["terms[0].thickness"]),
    "missing thickness": (membrane("thickness", DROP), ["terms[0]", "thickness", "missing"]),
    "missing stiffness": (membrane("young", DROP), ["terms[0].young", "missing"]),
    "Poisson's ratio -1": (membrane("poisson", -1), ["terms[0].poisson", "-1"]),
    "Poisson's ratio 1.2": (membrane("poisson", 1.2), ["terms[0].poisson", "1.2"]),
    "pressure NaN": (PLAIN.replace('"0.1 kPa"', "NaN"), ["scene.json:1:", "JSON"]),
    "pressure of text NaN": (changed((("terms", 1, "value"), "NaN kPa")), ["terms[1].value", "finite"]),
    "number beyond range": (PLAIN.replace("1e-06", "1e400"), ["1e400"]),
    "unknown pressure model": (changed((("terms", 1, "model"), "folower")), ["terms[1].model", "follower"]),
    "two terms of one name": (changed((("terms", 0, "name"), "a"), (("terms", 1, "name"), "a")), ["terms[1].name"]),
    "zero direction": (extra(type="load_field", direction=[0, 0, 0], force="1 N"), ["terms[2]", "direction"]),
    "direction in the plane": (extra(type="load_field", direction=[0, 1], force="1 N"), ["terms[2].direction"]),
    "load without size": (extra(type="load_field", direction=[0, 0, 1]), ["terms[2]", "pressure", "force"]),
    "gravity without mass": (extra(type="load_field", gravity=["0 m/s^2"] * 3), ["terms[2]", "density"]),
    "contact of exponent 1": (extra(type="contact_facet", exponent=1), ["terms[2].exponent"]),
    "contact of negative range": (extra(type="contact_facet", range="-1 mm"), ["terms[2].range"]),
    "zero tolerance": (changed((("solver", "tolerance"), 0)), ["solver.tolerance"]),
    "unknown solver": (changed((("solver", "type"), "lbgfs")), ["solver.type", "lbfgs"]),
    "broken iteration count": (changed((("solver", "max_iterations"), 1.5)), ["solver.max_iterations", "1.5"]),
    "time without unit": (changed((("solver", "max_seconds"), 5)), ["solver.max_seconds", "unit"]),
    "missing mesh file": (changed((("mesh", "file"), "nothere.obj")), ["mesh.file", "nothere.obj"]),
    "no mesh": (changed((("mesh",), DROP)), ["mesh", "missing"]),
    "missing network": (chords("nothere.json"), ["terms[2].network", "nothere.json"]),
    "negative node": (changed((("boundary", 0, "nodes"), [-1])), ["boundary[0].nodes[0]", "-1"]),
    "unknown coordinate": (changed((("boundary", 0, "fix"), ["w"])), ["boundary[0].fix", "w"]),
    "boundary without effect": (changed((("boundary", 0, "fix"), DROP)), ["boundary[0]", "fix"]),
    "two selections in one": (changed((("boundary", 0, "nodes"), {"plane": {"axis": "x"}, "nearest": [0, 0, 0]})),
                              ["boundary[0].nodes", "plane", "nearest"]),
    "plane without normal": (changed((("boundary", 0, "nodes"), {"plane": {"at": 1}})),
                             ["boundary[0].nodes.plane", "axis", "normal"]),
    "half-space of zero normal": (changed((("boundary", 0, "nodes"), {"half_space": {"normal": [0, 0, 0]}})),
                                  ["boundary[0].nodes.half_space.normal", "zero"]),
    "sphere without radius": (changed((("boundary", 0, "nodes"), {"sphere": {"centre": [0, 0, 0]}})),
                              ["boundary[0].nodes.sphere.radius", "missing"]),
    "unreadable condition": (changed((("boundary", 0, "nodes"), {"where": "z > 2 kPa"})),
                             ["boundary[0].nodes.where", "column 7", "length"]),
    "duplicate key": (PLAIN.replace('"poisson": 0.3', '"poisson": 0.3, "poisson": 0.2'), ["poisson", "twice"]),
    "empty file": ("", ["scene.json:1:1", "JSON"]),
    "empty scene": ("{}", ["terms", "missing"]),
    "list for a scene": ("[]", ["scene.json", "object"]),
    "truncated": (PLAIN[:80], ["scene.json:1:81"]),
    "text after the end": (PLAIN + " x", ["scene.json:1:"]),
    "open comment": ("/* " + PLAIN, ["comment"]),
    "deep lists": ("[" * 1000000, ["nested"]),
    "deep objects": ('{"a":' * 1000000 + "1" + "}" * 1000000, ["nested"]),
    "Latin-1": (PLAIN.encode().replace(b"mesh.obj", b"m\xe9sh.obj"), ["UTF-8"]),
    "UTF-16": (PLAIN.encode("utf-16"), ["scene.json:1:1"]),
    "binary": (bytes(range(256)) * 4, ["scene.json:1:1"]),
}

# As above, but seen only when the mesh and the networks have been read.
BAD_MODELS = {
    "missing set": (changed((("boundary", 0, "nodes"), "annulus")), ["boundary[0].nodes", "annulus", "boundary"]),
    "missing node": (changed((("boundary", 0, "nodes"), [0, 9999])), ["boundary[0].nodes", "9999"]),
    "missing region": (membrane("region", "foo"), ["terms[0].region", "foo"]),
    "empty selection": (changed((("boundary", 0, "nodes"), {"plane": {"axis": "x", "at": 1000}})),
                        ["boundary[0].nodes", "no node"]),
    "condition that none meets": (changed((("boundary", 0, "nodes"), {"where": "z > 1 km"})),
                                  ["boundary[0].nodes", "no node"]),
    "sets in a circle": (changed((("sets",), {"a": "b", "b": "a"})), ["sets.a", "sets.b"]),
    "too few targets": (changed((("boundary", 0, "move_to"), "short.csv")), ["boundary[0].move_to", "short.csv"]),
    "chord to a missing node": (chords("far.json"), ["far.json", "chords[0].to.leaflet", "9999"]),
    "chord of negative length": (chords("negative.json"), ["negative.json", "chords[0].rest_length"]),
    "chord to itself": (chords("loop.json"), ["loop.json", "chords[0]"]),
    "network that is a list": (chords("list.json"), ["list.json", "object"]),
    "potential on a free rim": (changed((("terms", 1, "model"), "volume"), (("boundary", 0, "nodes"), [0, 1, 2])),
                                ["terms[1].model", "volume", "follower"]),
    "unknown mesh format": (changed((("mesh", "file"), "mesh.xyz")), ["mesh.xyz", ".obj"]),
}

# Folders, empty, that the command makes before it has read the mesh.
MADE_TOO_EARLY = set()
# Meshes to warn of that are handled in silence: the origin is moved, so that no digit is lost.
SILENT = set()


def coapt(*arguments):
    run = subprocess.run([COAPT, *map(str, arguments)], capture_output=True, timeout=120)
    return run.returncode, run.stderr.decode(errors="replace")


class BadInputTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.scene = self.folder / "scene.json"
        (self.folder / "mesh.obj").write_text(SQUARE)
        for name, text in FILES.items():
            (self.folder / name).write_text(text)

    def assert_refused(self, command, pieces):
        before = set(self.folder.iterdir())
        code, errors = coapt(command, self.scene)
        self.assertEqual(code, 2, errors)
        for piece in pieces:
            self.assertIn(piece, errors)
        for line in errors.splitlines():
            self.assertTrue(line.startswith("coapt: error: "), line)
        written = [p for new in set(self.folder.iterdir()) - before for p in [new, *new.rglob("*")] if p.is_file()]
        self.assertEqual(written, [], "no file is written")
        return set(self.folder.iterdir()) - before

    def refuse(self, table, tolerated):
        for name, (text, pieces) in table.items():
            for command in ["check", "solve"]:
                with self.subTest(name, command=command):
                    self.scene.write_bytes(text if isinstance(text, bytes) else text.encode())
                    left = self.assert_refused(command, ["scene.json" if table is BAD_SCENES else "error", *pieces])
                    self.assertLessEqual({p.name for p in left}, tolerated)
                    for folder in left:
                        folder.rmdir()

    def test_the_unchanged_scene_is_good(self):
        self.scene.write_text(PLAIN)
        code, errors = coapt("solve", self.scene)
        self.assertEqual((code, errors), (0, ""))

    def test_refuses_bad_scenes_by_name_of_file_and_key(self):
        self.refuse(BAD_SCENES, tolerated=set())

    def test_refuses_scenes_that_do_not_fit_their_files(self):
        self.refuse(BAD_MODELS, tolerated=MADE_TOO_EARLY)

    def test_names_all_defects_in_one_pass(self):
        self.scene.write_text(changed((("terms", 0, "young"), "-1 MPa"), (("terms", 1, "value"), "1 kg"),
                                      (("solver", "tolerance"), -1), (("boundary", 0, "fix"), ["w"]), (("meshh",), 1)))
        self.assert_refused("solve", ["terms[0].young", "terms[1].value", "solver.tolerance", "boundary[0].fix",
                                      "meshh"])

    def test_accepts_a_byte_order_mark_and_comments(self):
        self.scene.write_bytes(b"\xef\xbb\xbf// a scene\n" + PLAIN.encode())
        self.assertEqual(coapt("solve", self.scene), (0, ""))

    def test_refuses_a_scene_beyond_the_size_that_is_read(self):
        with open(self.scene, "w") as scene:
            scene.write('{"name": "' + "x" * 100_000_000 + '"}')
        self.assert_refused("solve", ["scene.json", "MB"])

    def test_gives_each_bad_mesh_its_verdict(self):
        if MESHES is None or not (MESHES / "expected.json").exists():
            self.skipTest("skipped: data not found")
        expected = json.loads((MESHES / "expected.json").read_text())
        self.assertEqual(len(expected), 33)
        scene = copy.deepcopy(SCENE)
        scene["boundary"][0]["nodes"] = [0, 1]
        scene["terms"].append({"type": "contact_facet"})
        scene["solver"]["max_iterations"] = 20
        self.scene.write_text(json.dumps(scene))
        for name, verdict in expected.items():
            (self.folder / "mesh.obj").write_bytes((MESHES / (name + ".obj")).read_bytes())
            with self.subTest(name, why=verdict["why"]):
                if verdict["verdict"] == "reject":
                    self.assert_refused("check", ["mesh.obj"])
                    left = self.assert_refused("solve", ["mesh.obj"])
                    self.assertLessEqual({p.name for p in left}, MADE_TOO_EARLY)
                    for folder in left:
                        folder.rmdir()
                else:
                    code, errors = coapt("solve", self.scene)
                    self.assertIn(code, (0, 1), errors)
                    result = self.folder / "result" / "result.json"
                    warnings = json.loads(result.read_text())["warnings"]
                    if verdict["verdict"] == "warn" and name not in SILENT:
                        self.assertNotEqual(warnings, [])
                    for file in result.parent.iterdir():
                        file.unlink()
                    result.parent.rmdir()


if __name__ == "__main__":
    arguments = sys.argv[3:] if len(sys.argv) > 2 else []
    unittest.main(argv=[sys.argv[0], *arguments])
