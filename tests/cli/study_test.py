"""Drives the studies of the command as a user does: sensitivity, mesh-study, tune-regions.

Usage: study_test.py COAPT_BINARY [unittest arguments]
"""
import csv
import json
import math
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import unittest

COAPT = os.path.abspath(sys.argv[1])


def coapt(*arguments):
    return subprocess.run([COAPT, *map(str, arguments)], capture_output=True, text=True, timeout=200)


class StudyTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.out = self.folder / "result"

    def generate(self, shape, *options):
        run = coapt("generate", shape, "-o", self.folder, *options)
        self.assertEqual(run.returncode, 0, run.stderr)
        return self.folder / "scene.json"

    def valve(self, triangles=300):
        return self.generate("mitral", "--preset", "benchmark", "--triangles", triangles, "--contact", "none")

    def study(self, name, *arguments, code=0):
        run = coapt(name, *arguments, "-o", self.out)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        self.assertEqual(run.stderr, "")
        file = {"sensitivity": "sensitivity", "mesh-study": "mesh_study", "tune-regions": "region_tuning"}[name]
        rows = list(csv.DictReader((self.out / f"{file}.csv").read_text().splitlines()))
        return run.stdout, json.loads((self.out / f"{file}.json").read_text()), rows

    def assert_bad_input(self, run, *pieces):
        self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
        for piece in pieces:
            self.assertIn(piece, run.stderr)

    # --- sensitivity

    def movements(self, *arguments):
        text, found, rows = self.study("sensitivity", *arguments)
        self.assertTrue(found["converged"], text)
        solves = "--perturb" in arguments or "--from-start" in arguments
        self.assertEqual(len(rows), 1 + (2 if solves else 1) * len(found["parameters"]))
        self.assertEqual({row["status"] for row in rows}, {"converged"} if solves else {"converged", "derivative"})
        self.assertEqual({p["by"] for p in found["parameters"]}, {"solves" if solves else "derivative"})
        return {p["name"]: p["movement_mm_per_100_percent"] for p in found["parameters"]}

    def test_chord_length_matters_most_to_a_valve(self):
        moved = self.movements(self.valve(625))
        self.assertEqual(set(moved), {"leaflets.young", "leaflets.poisson", "leaflets.thickness", "bending.scale",
                                      "chords.young", "chords.length_scale", "chords.diameter", "chords.smoothing"})
        # Hammer et al. 2011 found some 8 mm for the length of the chords, far less for their section.
        self.assertGreater(moved["chords.length_scale"], 5)
        self.assertLess(moved["chords.length_scale"], 12)
        for name in set(moved) - {"chords.length_scale"}:
            self.assertLess(moved[name], moved["chords.length_scale"] / 4, name)
        # Cross-sections go with the square of the diameter, and with the modulus they are one number.
        self.assertAlmostEqual(moved["chords.diameter"] / moved["chords.young"], 2, delta=0.1)

    def test_solves_from_the_first_solution_and_from_the_start_agree(self):
        scene, wanted = self.valve(), ["--parameters", "leaflets.young", "chords.length_scale", "--perturb", "0.1"]
        warm, cold = self.movements(scene, *wanted), self.movements(scene, *wanted, "--from-start")
        for name in warm:
            self.assertAlmostEqual(warm[name], cold[name], delta=1e-3 * warm[name])

    def test_derivatives_are_the_limit_of_small_changes(self):
        for contact in ["none", "barrier"]:
            scene = self.generate("mitral", "--preset", "benchmark", "--triangles", 300, "--contact", contact)
            derived = self.movements(scene, "--tolerance", 1e-10)
            solved = self.movements(scene, "--tolerance", 1e-11, "--perturb", "0.02%")
            self.assertEqual(set(derived), set(solved))
            for name in derived:
                self.assertAlmostEqual(derived[name], solved[name], delta=1e-2 * solved[name] + 1e-4, msg=(contact, name))
            self.assertGreater(derived["chords.length_scale"], 5)

    def test_the_derivative_by_a_scale_of_lengths_that_is_not_one(self):
        scene = self.valve()
        scene.write_text(scene.read_text().replace('"young": "40 MPa"', '"young": "40 MPa", "length_scale": 1.03'))
        wanted = ["--parameters", "chords.length_scale"]
        derived = self.movements(scene, "--tolerance", 1e-10, *wanted)["chords.length_scale"]
        solved = self.movements(scene, "--tolerance", 1e-11, "--perturb", "0.02%", *wanted)["chords.length_scale"]
        self.assertAlmostEqual(derived, solved, delta=1e-3 * solved)

    def test_loads_and_contact_have_derivatives_too(self):
        scene = self.generate("mitral", "--preset", "benchmark", "--triangles", 300, "--contact", "barrier")
        scene.write_text(scene.read_text().replace('"contact_barrier"', '"contact_barrier", "gap": "0.3 mm"'))
        wanted = ["--parameters", "load_pressure.value", "contact_barrier.gap"]
        derived, solved = self.movements(scene, *wanted), self.movements(scene, *wanted, "--perturb", "0.1%")
        for name in derived:
            self.assertGreater(derived[name], 0.01)
            self.assertAlmostEqual(derived[name], solved[name], delta=1e-2 * solved[name])

    def test_the_shape_of_a_film_goes_with_a_ratio(self):
        # Of the tension in the film to that of its edges. Its nodes may slide in it: where that makes the tangent singular
        # (here it depends on round-off whether it does) the study solves again, and says so.
        scene = pathlib.Path(__file__).parents[2] / "examples/05_four_point_tent/scene_flat.json"
        for tolerance in [1e-6, 3e-8, 1e-8]:
            text, found, _ = self.study("sensitivity", scene, "--parameters", "film.tension", "edge cables.tension",
                                        "--tolerance", tolerance)
            for parameter in found["parameters"]:
                self.assertAlmostEqual(parameter["movement_mm_per_100_percent"] / 25.455, 1,
                                       delta=1e-3 if parameter["by"] == "derivative" else 0.05)
                self.assertEqual(parameter["message"] != "", parameter["by"] == "solves")
                self.assertEqual(len(parameter["runs"]), 0 if parameter["by"] == "derivative" else 2)
            self.assertEqual("solved again: " in text, any(p["by"] == "solves" for p in found["parameters"]))

    def test_deflection_of_a_disc_goes_with_the_cube_root_of_its_stiffness(self):
        # Hencky: the deflection of a membrane without prestress is proportional to (E h)^(-1/3).
        scene = self.generate("disc", "--triangles", 400)
        moved = self.movements(scene, "--parameters", "cst_stvk.young", "cst_stvk.thickness", "--perturb", "2%")
        self.assertAlmostEqual(moved["cst_stvk.young"], moved["cst_stvk.thickness"], delta=1e-3)
        coapt("solve", scene, "-o", self.out)
        deflection = json.loads((self.out / "result.json").read_text())["metrics"]["max_displacement_mm"]
        # Its mean over the disc lies between that of a cone (1/3) and that of a cylinder (1).
        self.assertGreater(moved["cst_stvk.young"], deflection / 3 / 3)
        self.assertLess(moved["cst_stvk.young"], deflection / 3)

    def test_a_reference_surface_gives_a_change_of_error(self):
        scene = self.valve()
        coapt("solve", scene, "-o", self.out)
        (self.out / "closed.obj").rename(self.folder / "closed.obj")
        text = scene.read_text()
        scene.write_text(text.replace('"mesh":', '"reference": {"closed_surface": "closed.obj"}, "mesh":', 1))
        text, found, _ = self.study("sensitivity", scene, "--parameters", "chords.length_scale", "--perturb", "5%")
        self.assertLess(found["first"]["distance_to_reference"]["mean_mm"], 1e-6)
        parameter = found["parameters"][0]
        for run in parameter["runs"]:  # the reference is the first solution
            self.assertAlmostEqual(run["distance_to_reference"]["mean_mm"], run["distance_to_base"]["mean_mm"], places=6)
        self.assertLess(abs(parameter["error_change_mm_per_100_percent"]), parameter["movement_mm_per_100_percent"])

    def test_names_of_followed_equilibria_are_taken_too(self):
        scene = self.valve()
        _, found, _ = self.study("sensitivity", scene, "--parameters", "chords.length", "load_pressure.pressure")
        _, keys, _ = self.study("sensitivity", scene, "--parameters", "chords.length_scale", "load_pressure.value")
        for here, there in zip(found["parameters"], keys["parameters"], strict=True):
            self.assertEqual(here["name"], there["name"])  # the key of the scene
            self.assertEqual(here["movement_mm_per_100_percent"], there["movement_mm_per_100_percent"])

    def test_says_which_solves_did_not_converge(self):
        scene = self.valve()
        scene.write_text(scene.read_text().replace('"solver": {', '"solver": {"max_iterations": 17, '))
        text, found, rows = self.study("sensitivity", scene, "--from-start", "--parameters", "chords.length_scale",
                                       "--perturb", "60%", code=1)
        self.assertIn("iteration_limit", text)
        self.assertIn("iteration_limit", {row["status"] for row in rows})
        self.assertFalse(found["converged"])

    def test_an_interrupted_study_says_so(self):
        scene = self.valve(2500)
        for number in [signal.SIGINT, signal.SIGTERM]:
            process = subprocess.Popen([COAPT, "sensitivity", str(scene), "-o", str(self.out), "--from-start"],
                                       stdout=subprocess.PIPE, text=True,
                                       preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
            self.addCleanup(process.kill)
            while "leaflets.young" not in process.stdout.readline():  # the first of eight parameters
                self.assertIsNone(process.poll())
            process.send_signal(number)
            text, _ = process.communicate(timeout=100)
            self.assertEqual(process.returncode, 1, text)
            self.assertIn("cancelled", text)
            found = json.loads((self.out / "sensitivity.json").read_text())
            self.assertEqual((found["converged"], found["cancelled"]), (False, True))
            self.assertLess(len(found["parameters"]), 8)
            self.assertEqual(len((self.out / "sensitivity.csv").read_text().splitlines()),
                             2 + 2 * len(found["parameters"]))

    def test_leaves_out_what_may_not_be_changed_so_far(self):
        scene = self.valve()
        scene.write_text(scene.read_text().replace('"poisson": 0.45', '"poisson": 0.48'))
        self.assertIn("leaflets.poisson", self.movements(scene))
        text, found, _ = self.study("sensitivity", scene, "--perturb", "5%")
        self.assertTrue(found["converged"], text)
        self.assertNotIn("leaflets.poisson", [p["name"] for p in found["parameters"]])
        self.assertIn("leaflets.young", [p["name"] for p in found["parameters"]])
        self.assertEqual(len(found["left_out"]), 1)
        self.assertIn("0.4999", found["left_out"][0])
        self.assertIn("left out: ", text)
        # Who names it is told.
        self.assert_bad_input(coapt("sensitivity", scene, "--parameters", "leaflets.poisson", "--perturb", "5%"), "0.4999")

    def test_lists_of_numbers_are_parameters(self):
        scene = self.valve()
        text = scene.read_text()
        scene.write_text(text.replace('"type": "cable"', '"type": "cable_ogden", "mu": ["3 MPa", "1 MPa"], "alpha": [8, 4]')
                         .replace(', "young": "40 MPa"', ""))
        self.assertNotEqual(scene.read_text(), text)
        moved = self.movements(scene, "--perturb", "2%")
        self.assertLessEqual({"chords.mu", "chords.alpha", "chords.length_scale"}, set(moved))
        # All moduli together are as good as the cross-sections.
        self.assertAlmostEqual(moved["chords.diameter"] / moved["chords.mu"], 2, delta=0.1)
        self.assertGreater(moved["chords.alpha"], 0.01)

    def test_names_with_commas_stay_in_their_columns(self):
        scene = self.generate("disc", "--triangles", 100)
        scene.write_text(scene.read_text().replace('"type": "cst_stvk",', '"type": "cst_stvk", "name": "a,\\"b",'))
        _, _, rows = self.study("sensitivity", scene, "--parameters", 'a,"b.young')
        self.assertEqual([row["parameter"] for row in rows], ["", 'a,"b.young'])
        self.assertEqual([row["status"] for row in rows], ["converged", "derivative"])

    def test_names_every_bad_parameter(self):
        run = coapt("sensitivity", self.valve(), "--parameters", "young", "leaflet.young", "leaflets.yuong",
                    "leaflets.prestress", "--perturb", "5")
        self.assert_bad_input(run, '"young"', "TERM.KEY", '"leaflets"?', '"young"?', "is zero", "--perturb")
        self.assertFalse((self.out / "sensitivity.json").exists())
        run = coapt("sensitivity", self.folder / "scene.json", "--parameters", "leaflets.poisson", "--perturb", "20%")
        self.assert_bad_input(run, "leaflets.poisson", "0.4999")
        self.assert_bad_input(coapt("sensitivity", self.folder / "scene.json", "--perturb", "much"), "--perturb", "much")

    # --- mesh-study

    def test_refined_disc_converges_with_second_order(self):
        _, found, rows = self.study("mesh-study", self.generate("square", "--triangles", 128), "--levels", 3)
        levels = found["levels"]
        self.assertEqual([level["triangles"] for level in levels], [levels[0]["triangles"] * 4**k for k in range(4)])
        self.assertTrue(all(level["status"] == "converged" for level in levels))
        self.assertGreater(levels[3]["order"], 1.5)
        self.assertLess(levels[3]["order"], 2.5)
        self.assertEqual(len(rows), 4)
        for level in levels:
            self.assertTrue((self.out / level["file"]).exists())

    def test_refined_valve_keeps_its_supports_and_chords(self):
        text, found, _ = self.study("mesh-study", self.valve(), "--levels", 1)
        coarse, fine = found["levels"]
        self.assertLess(fine["distance_to_previous"]["mean_mm"], 0.5)
        self.assertAlmostEqual(fine["max_chord_force_n"] / coarse["max_chord_force_n"], 1, delta=0.2)
        self.assertAlmostEqual(fine["orifice_area_mm2"], coarse["orifice_area_mm2"], delta=5)
        self.assertIn("triangles", text)

    def test_says_before_the_first_solve_what_finer_meshes_cannot_have(self):
        scene = self.generate("mitral", "--preset", "benchmark", "--triangles", 300, "--contact", "barrier")
        (self.folder / "pairs.csv").write_text("0,1\n")
        scene.write_text(scene.read_text().replace('"contact_barrier"', '"contact_barrier", "exclude": "pairs.csv"'))
        run = coapt("mesh-study", scene, "-o", self.out)
        self.assert_bad_input(run, "exclude", "scene's own mesh")
        self.assertEqual(run.stdout, "")

    def test_refuses_levels_and_scenes_without_a_mesh(self):
        self.assertEqual(coapt("mesh-study", self.valve(), "--levels", 0).returncode, 2)
        self.assert_bad_input(coapt("mesh-study", self.generate("catenary")), "mesh")

    # --- tune-regions

    def test_tunes_an_overstrained_valve(self):
        text, found, rows = self.study("tune-regions", self.valve(625), "--yield-strain", 0.12)
        self.assertTrue(found["reached"], text)
        self.assertGreater(found["before"]["max_chord_strain"], 0.15)
        self.assertGreater(found["before"]["strained_chords"], 0)
        self.assertLessEqual(found["after"]["max_chord_strain"], 0.12)
        self.assertEqual(found["after"]["strained_chords"], 0)
        self.assertLessEqual(found["after"]["orifice_area_mm2"], found["orifice_limit_mm2"])
        self.assertEqual(len(rows), 14)
        self.assertEqual(sum(int(row["triangles"]) for row in rows), 630)
        self.assertGreater(max(abs(math.log(float(row["factor"]))) for row in rows), 0.1)
        per_triangle = list(csv.DictReader((self.out / "triangle_factors.csv").read_text().splitlines()))
        factors = {row["name"]: row["factor"] for row in rows}
        self.assertEqual(len(per_triangle), 630)
        self.assertTrue(all(factors[row["region"]] == row["factor"] for row in per_triangle))

    def test_cross_sections_need_less(self):
        _, found, _ = self.study("tune-regions", self.valve(), "--yield-strain", 0.12, "--regions", "mesh",
                                 "--chord-sections")
        self.assertTrue(found["reached"])
        self.assertEqual([region["name"] for region in found["regions"]], ["anterior", "posterior"])
        self.assertGreater(found["chords"][0]["area_scale"], 1)

    def test_says_what_cannot_be_reached(self):
        text, found, _ = self.study("tune-regions", self.valve(), "--yield-strain", 1e-4, "--greatest-factor", 1.2,
                                    "--regions", "mesh", code=1)
        self.assertFalse(found["reached"])
        self.assertIn("no factors from 0.833333 to 1.2", text)
        self.assertGreater(found["after"]["strained_chords"], 0)

    def test_leaves_a_valve_alone_that_needs_nothing(self):
        _, found, rows = self.study("tune-regions", self.valve(), "--yield-strain", 1)
        self.assertEqual((found["message"], found["solves"]), ("nothing to tune", 1))
        self.assertEqual({row["factor"] for row in rows}, {"1"})

    def sheet(self, membranes, chord_to):
        """A clamped sheet of two regions, a chord from a fixed point below, twice as long as at rest."""
        lines = [f"v {i} {j} 0" for j in range(5) for i in range(5)]
        for name, columns in [("left,one", (1, 2)), ("right", (3, 4))]:
            lines.append(f"g {name}")
            for k in (i + 5 * j for j in range(4) for i in columns):
                lines += [f"f {k} {k + 1} {k + 6}", f"f {k} {k + 6} {k + 5}"]
        (self.folder / "mesh.obj").write_text("\n".join(lines) + "\n")
        (self.folder / "net.json").write_text(json.dumps({
            "units": "mm", "papillary": [[2, 2, -2], [4, 2, -2]], "junctions": [],
            "chords": [{"from": {"papillary": 0}, "to": chord_to, "rest_length": 1, "area": 0.1}]}))
        scene = {"mesh": {"file": "mesh.obj"},
                 "boundary": [{"nodes": "boundary", "fix": True}, {"nodes": "papillary", "fix": True}],
                 "terms": [*membranes, {"type": "cable", "name": "chord", "network": "net.json", "young": "1 MPa"},
                           {"type": "load_pressure", "value": "1 kPa"}]}
        path = self.folder / "scene.json"
        path.write_text(json.dumps(scene))
        return path

    FILM = {"type": "surface_tension", "name": "film", "tension": "1 N/m"}
    TISSUE = {"type": "cst_stvk", "name": "tissue", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm"}

    def test_marks_regions_that_have_no_modulus(self):
        scene = self.sheet([{**self.FILM, "region": "left,one"}, {**self.TISSUE, "region": "right"}], {"leaflet": 12})
        text, found, rows = self.study("tune-regions", scene, "--yield-strain", 0.1, "--regions", "mesh", code=1)
        self.assertEqual([(r["name"], r["tuned"]) for r in found["regions"]], [("left,one", False), ("right", True)])
        self.assertEqual(found["regions"][0]["factor"], 1)
        self.assertIn("not tuned", text)
        self.assertEqual([row["name"] for row in rows], ["left,one", "right"])
        per_triangle = list(csv.DictReader((self.out / "triangle_factors.csv").read_text().splitlines()))
        self.assertEqual({row["region"] for row in per_triangle}, {"left,one", "right"})
        self.assert_bad_input(coapt("tune-regions", self.sheet([self.FILM], {"leaflet": 12}), "--yield-strain", 0.1,
                                    "--regions", "mesh"), "modulus")
        held_by_prestress = {**self.TISSUE, "young": 0, "prestress": "1 N/m"}
        self.assert_bad_input(coapt("tune-regions", self.sheet([held_by_prestress], {"leaflet": 12}), "--yield-strain",
                                    0.1, "--regions", "mesh"), "modulus")

    def test_says_when_no_factor_matters(self):
        # A chord between two fixed points.
        scene = self.sheet([self.TISSUE], {"papillary": 1})
        text, found, _ = self.study("tune-regions", scene, "--yield-strain", 0.1, "--regions", "mesh", code=1)
        self.assertIn("no factor changes", found["message"])
        self.assertEqual(found["failed_solves"], 0)

    def test_refuses_an_annulus_that_bounds_nothing(self):
        scene = self.valve()
        text = scene.read_text().replace('{ "nodes": "annulus", "move_to": "annulus_closed" }',
                                         '{ "nodes": "boundary", "fix": true }')
        vertices = sum(line.startswith("v ") for line in (self.folder / "leaflets.obj").read_text().splitlines())
        for annulus in ["all", list(range(vertices))]:
            scene.write_text(text.replace('"mesh":', f'"sets": {{"annulus": {json.dumps(annulus)}}}, "mesh":', 1))
            run = coapt("tune-regions", scene, "--yield-strain", 0.1, "-o", self.out)
            self.assert_bad_input(run, "scene.json", "annulus")

    def test_refuses_options_without_effect_and_numbers_that_are_none(self):
        scene = self.valve()
        strain = ["--yield-strain", 0.1]
        self.assert_bad_input(coapt("tune-regions", scene, *strain, "--regions", "mesh", "--zones", 2), "--zones")
        for number in ["-1", "half", "nan"]:
            for command in ["mesh-study", "tune"]:
                self.assert_bad_input(coapt(command, scene, "--damped-steps", number), "--damped-steps", number,
                                      "whole number")
        for command, options in [("tune-regions", strain), ("sensitivity", []), ("mesh-study", []), ("solve", [])]:
            for option in ["--tolerance", "--max-seconds"] + ["--orifice"] * (command == "tune-regions"):
                for number in ["nan", "inf", "-1", "0"]:
                    self.assert_bad_input(coapt(command, scene, *options, option, number), option, number)
        sheet = self.sheet([self.TISSUE], {"leaflet": 12})
        self.assert_bad_input(coapt("tune-regions", sheet, *strain, "--regions", "mesh", "--orifice", 3), "--orifice",
                              "annulus")

    def test_refuses_scenes_and_options_that_make_no_sense(self):
        scene = self.valve()
        self.assert_bad_input(coapt("tune-regions", scene), "--yield-strain")
        self.assert_bad_input(coapt("tune-regions", scene, "--yield-strain", 0.1, "--regions", 3), "3 regions", "2 zones")
        self.assert_bad_input(coapt("tune-regions", scene, "--yield-strain", 0.1, "--regions", "many"), "mesh")
        scene = self.generate("disc", "--triangles", 100)
        self.assert_bad_input(coapt("tune-regions", scene, "--yield-strain", 0.1), "annulus")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
