"""Valves and chords that the command makes."""
import json
import unittest

from command_case import CommandCase, coapt


class GenerateTest(CommandCase):
    def test_generates_a_valve_on_a_measured_annulus(self):
        scene = self.generate("mitral", "--triangles", 2500)
        ring, tips = self.folder / "ring.mrk.json", self.folder / "tips.mrk.json"
        for name, path in [("annulus", ring), ("papillary", tips)]:
            self.assertEqual(coapt("export", scene, "--points", name, "-o", path).returncode, 0)
        scene = self.generate("mitral", "--triangles", 625, "--annulus", ring, "--papillary", tips)
        run = coapt("solve", scene)
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        result = self.result()
        self.assertTrue(result["converged"])
        self.assertEqual(result["metrics"]["intersections"], 0)
        self.assertIn("contact_barrier", scene.read_text())

        points = [point["position"] for point in json.loads(ring.read_text())["markups"][0]["controlPoints"]]
        table = self.folder / "ring.csv"
        table.write_text("x,y,z\n" + "".join(f"{x},{y},{z}\n" for x, y, z in points))
        self.generate("mitral", "--triangles", 300, "--annulus", table, "--anterior", 0, 50, 0, "--ventricle", 0, 0, -9)
        mitral = lambda *options: coapt("generate", "mitral", "-o", self.folder / "x", *options)
        table.write_text("".join(f"{x} {y} {z}\n" for x, y, z in points[:len(points) // 2]))
        self.assert_bad_input(mitral("--annulus", table), "ring.csv", "the curve is open")
        table.write_text("".join(f"{x / 10} {y / 10} {z / 10}\n" for x, y, z in points))
        self.assert_bad_input(mitral("--annulus", table), "ring.csv", "positions in mm?")
        table.write_text("".join(f"{x} {y} {z}\n" for x, y, z in points[::len(points) // 6]))
        self.assert_bad_input(mitral("--annulus", table), "ring.csv", "at least 8")
        self.assert_bad_input(mitral("--anterior", 0, 1, 0), "--annulus FILE")
        self.assert_bad_input(coapt("generate", "disc", "--annulus", ring, "-o", self.folder / "x"), "mitral")

    def test_generates_rough_valves(self):
        for shape in ["mitral", "tricuspid"]:
            with self.subTest(shape=shape):
                scene = self.generate(shape, "--rough", 1, "--triangles", 300)
                self.assertIn('"contact_barrier"', scene.read_text())
                self.assertIn('"follower"', scene.read_text())
                files = ["scene.json", "valve.json", "leaflets.obj"]
                first = [(self.folder / name).read_bytes() for name in files]
                self.generate(shape, "--rough", 1, "--triangles", 300)
                self.assertEqual(first, [(self.folder / name).read_bytes() for name in files])
                self.generate(shape, "--rough", 2, "--triangles", 300)
                self.assertNotEqual(first, [(self.folder / name).read_bytes() for name in files])
                self.assertIn("no defects", coapt("check", scene).stdout)
        generate = lambda *options: coapt("generate", *options, "-o", self.folder / "x")
        self.assert_bad_input(generate("tricuspid"), "--rough SEED")
        self.assert_bad_input(generate("disc", "--rough", 1), "--rough", "disc")
        self.assert_bad_input(generate("mitral", "--rough", 1, "--seed", 2), "--seed")
        self.assert_bad_input(generate("tricuspid", "--rough", 1, "--model", "hammer-2008"), "--model")
        self.assert_bad_input(generate("mitral", "--rough", 1, "--triangles", 100), "at least 250")

    def test_generates_valves_of_springs(self):
        springs = ["--membrane", "spring"]
        for options in [springs, [*springs, "--preset", "closed"], ["--model", "hammer-2008"], ["--model", "hammer-2011"]]:
            with self.subTest(" ".join(options)):
                scene = self.generate("mitral", "--triangles", 400, "--contact", "none", *options)
                run = coapt("check", scene)
                self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
                run = coapt("solve", scene)
                self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
                result = self.result()
                self.assertGreater(result["counters"]["spring_elements"], 600)
                self.assertEqual(result["counters"]["membrane_elements"], 0)
                self.assertIsNone(result["metrics"]["slack_area_mm2"])
                self.assertNotIn("regime", (self.folder / "result" / "closed.vtp").read_text(errors="replace"))
        self.assertEqual(coapt("generate", "mitral", "--model", "hammer", "-o", self.folder / "x").returncode, 2)

    def test_gives_a_valve_of_a_file_the_model_of_a_paper(self):
        self.generate("mitral", "--triangles", 300)
        valve, paper = self.folder / "valve.json", self.folder / "paper"
        run = coapt("import", valve, "--model", "burlina-2010", "-o", paper)
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        self.assertIn("leaves open", (paper / "README.md").read_text())
        self.assertIn("half_space", (paper / "scene.json").read_text())
        run = coapt("check", paper / "scene.json")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        bad = lambda *options: coapt("import", valve, "-o", self.folder / "x", *options)
        for options in [["--model", "burlina"], ["--model", "hammer-2008", "--membrane", "stvk"]]:
            run = bad(*options)
            self.assertEqual(run.returncode, 2, run.stdout)
            self.assertIn("--model", run.stderr)
        self.assert_bad_input(bad("--model", "burlina-2010", "--young", "1 MPa"), "--young", "--model")
        self.assert_bad_input(bad("--model", "burlina-2010", "--pressure", "follower"), "--pressure")
        self.assert_bad_input(coapt("import", self.folder / "leaflets.obj", "--model", "burlina-2010", "-o", self.folder / "x"),
                              "leaflets.obj", "--papillary")

    def test_makes_chords_where_there_are_none(self):
        self.generate("mitral", "--triangles", 625)
        network = self.folder / "made" / "valve.json"
        run = coapt("chords", self.folder / "valve.json", "-o", network, "--count", 8, "--levels", 2,
                    "--zones", "free_edge", "rough", "--depth", 8)
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        self.assertIn("64 chords, 16 branch points", run.stdout)
        chords = json.loads(network.read_text())["chords"]
        self.assertEqual(sorted({c["material"] for c in chords}), ["primary", "secondary"])
        self.assertEqual([len([c for c in chords if c["level"] == level]) for level in (1, 2)], [16, 48])
        self.assertEqual(coapt("import", network, "-o", self.folder / "scene").returncode, 0)
        run = coapt("solve", self.folder / "scene" / "scene.json")
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)

    def test_makes_chords_on_a_mesh_alone(self):
        self.generate("mitral", "--triangles", 625)
        mesh, network = self.folder / "leaflets.obj", self.folder / "made" / "valve.json"
        tips = ["--tip", 16, 0, -24, "--tip", -16, 0, -24]
        run = coapt("chords", mesh, "-o", network, "--scale", 0.8, *tips)
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        valve, known = json.loads(network.read_text()), json.loads((self.folder / "valve.json").read_text())
        self.assertEqual(sorted(valve["annulus"]), sorted(known["annulus"]))
        self.assertEqual(sorted(valve["free_edge"]), sorted(known["free_edge"]))
        self.assertEqual((len(valve["chords"]), valve["papillary"]), (24, [[16, 0, -24], [-16, 0, -24]]))
        unseen = coapt("chords", mesh, "-o", network)
        self.assertEqual((unseen.returncode, unseen.stderr), (0, ""), unseen.stdout)
        self.assertIn("tips:    not known", unseen.stdout)
        valve = json.loads(network.read_text())
        self.assertEqual(sorted(valve["annulus"]), sorted(known["annulus"]))
        self.assertEqual((len(valve["chords"]), len(valve["papillary"])), (24, 2))
        self.assertEqual(coapt("import", network, "-o", self.folder / "unseen").returncode, 0)
        edge = known["free_edge"]
        chosen = [",".join(map(str, edge[:4])), ",".join(map(str, edge[20:23]))]
        run = coapt("chords", mesh, "-o", network, "--insertions", chosen[0], "--insertions", chosen[1])
        self.assertEqual((run.returncode, run.stderr), (0, ""), run.stdout)
        self.assertIn("with 4 chords", run.stdout)
        self.assertEqual({c["to"]["leaflet"] for c in json.loads(network.read_text())["chords"]}, {*edge[:4], *edge[20:23]})
        for wrong, what in (("3,x", "\"x\""), ("99999", "no such vertex"), (f"{edge[0]},{edge[0]}", "named twice"),
                            (str(known["annulus"][0]), "on the annulus"), (str(edge[0]), "half 1")):
            self.assert_bad_input(coapt("chords", mesh, "-o", network, "--insertions", wrong), what)
        self.assert_bad_input(coapt("chords", mesh, "-o", self.folder / "x.json", *tips), "another folder")
        self.assert_bad_input(coapt("chords", mesh, "-o", network, "--count", 999, *tips), "free vertices")
        for bad in ("nan", "1e400", "1e200"):
            self.assert_bad_input(coapt("chords", mesh, "-o", network, "--tip", bad, 0, 0), "not finite")
        self.assert_bad_input(coapt("chords", mesh, "-o", network, "--tip", 1, 2, 90, "--scale", -1), "scale")


if __name__ == "__main__":
    unittest.main(argv=[__file__])
