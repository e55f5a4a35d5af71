"""Drives `coapt compare` as a user does.

Usage: compare_test.py COAPT_BINARY [unittest arguments]
"""
import csv
import json
import sys
import unittest

import command_case


def coapt(*arguments, **options):
    return command_case.coapt(*arguments, timeout=200, **options)


class CompareTest(command_case.CommandCase):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "result"

    def valve(self, *options, triangles=300):
        return self.generate("mitral", "--triangles", triangles, "--contact", "none", *options)

    def compare(self, scene, *arguments, code=0):
        run = coapt("compare", scene, "-o", self.out, *arguments)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        self.assertEqual(run.stderr, "")
        rows = list(csv.DictReader((self.out / "compare.csv").read_text().splitlines()))
        return run.stdout, json.loads((self.out / "compare.json").read_text()), rows

    def test_methods_on_one_energy_agree(self):
        text, found, rows = self.compare(self.valve(), "--methods", "lbfgs,newton,bfgs")
        self.assertTrue(found["converged"], text)
        self.assertEqual(found["reference"], "newton")
        self.assertEqual([m["name"] for m in found["methods"]], ["newton", "lbfgs", "bfgs"])
        self.assertEqual([m["verdict"] for m in found["methods"]], ["reference"] + 2 * ["same equilibrium"])
        for method in found["methods"][1:]:
            self.assertLessEqual(method["distance_to_reference_method"]["same_vertex"]["max_mm"],
                                 found["same_shape_mm"])
            self.assertIn("orifice_area_mm2", method["metrics"])
        self.assertEqual([row["method"] for row in rows], ["newton", "lbfgs", "bfgs"])
        self.assertEqual([row["message"] for row in rows], [m["message"] for m in found["methods"]])
        self.assertAlmostEqual(float(rows[1]["cpu_s"]), found["methods"][1]["time"]["cpu_s"], places=6)
        for word in ["newton", "lbfgs", "same equilibrium", "orifice", "compare.html"]:
            self.assertIn(word, text)

    def test_static_dynamic_and_other_models_side_by_side(self):
        text, found, rows = self.compare(self.valve(), "--tolerance", "1e-8", code=1)  # xpbd finds no equilibrium
        methods = {method["name"]: method for method in found["methods"]}
        self.assertEqual(set(methods), {"newton", "lbfgs", "dynamic", "dynamic-explicit", "mass-spring", "xpbd"}, text)
        self.assertEqual({name: method["verdict"] for name, method in methods.items()},
                         {"newton": "reference", "lbfgs": "same equilibrium", "dynamic": "same equilibrium",
                          "dynamic-explicit": "same equilibrium", "mass-spring": "model gap", "xpbd": "model gap"}, text)
        self.assertEqual([methods[name]["model"] for name in ("dynamic", "mass-spring", "xpbd")],
                         ["scene", "springs", "constraints"])
        self.assertTrue(all(methods[name]["converged"] for name in methods if name != "xpbd"), text)
        for name in ("mass-spring", "xpbd"):
            gap = methods[name]["distance_to_reference_method"]
            self.assertGreater(gap["mean_mm"], 1e-3, name)
            self.assertLess(gap["mean_mm"], 5, name)
            self.assertIn(f"mean {gap['mean_mm']:.3g}", methods[name]["message"])
            self.assertIn(b"distance_to_reference_method", (self.out / name / "closed.vtp").read_bytes())
        self.assertEqual([methods[name]["shares_with_newton"] for name in ("newton", "lbfgs", "dynamic", "dynamic-explicit")],
                         ["all", "energy", "energy + factorisation", "energy"])
        self.assertEqual([len(line) for line in text.splitlines() if len(line) > 120], [], text)
        for name in ("dynamic", "dynamic-explicit", "mass-spring", "xpbd"):
            self.assertGreater(methods[name]["simulated_s"], 0, name)
        self.assertIsNone(methods["newton"]["simulated_s"])
        self.assertEqual([row["verdict"] for row in rows], [m["verdict"] for m in found["methods"]])

    def test_springs_alone_are_one_model(self):
        scene = self.valve("--model", "hammer-2011")
        text, found, _ = self.compare(scene, "--methods", "dynamic,mass-spring", "--tolerance", "1e-6")
        self.assertEqual([m["model"] for m in found["methods"]], ["scene", "scene"], text)
        self.assertTrue(found["converged"], text)
        self.assertIn(found["methods"][1]["verdict"], ("same equilibrium", "another branch"), text)

    def test_mass_spring_is_a_solver_of_springs(self):
        solved = self.folder / "solved"
        springs = coapt("solve", self.valve("--model", "hammer-2011"), "-o", solved, "--solver", "mass-spring", "--tolerance", "1e-6")
        self.assertEqual(springs.returncode, 0, springs.stdout + springs.stderr)
        result = json.loads((solved / "result.json").read_text())
        self.assertEqual(result["solver"]["type"], "mass-spring")
        self.assertLessEqual(result["residual"], 1e-6)
        refused = coapt("solve", self.valve(), "--solver", "mass-spring")
        self.assertEqual(refused.returncode, 2, refused.stdout + refused.stderr)
        for word in ("\"leaflets\" (cst_tension_field)", "coapt compare --methods mass-spring", "dynamic-explicit"):
            self.assertIn(word, refused.stderr)

    def test_results_are_those_of_solve(self):
        scene = self.valve()
        _, found, _ = self.compare(scene, "--methods", "newton,lbfgs", "--reference", "lbfgs")
        self.assertEqual(found["reference"], "lbfgs")
        solved = self.folder / "solved"
        self.assertEqual(coapt("solve", scene, "-o", solved, "--solver", "newton").returncode, 0)
        there, here = (json.loads((folder / "result.json").read_text()) for folder in (solved, self.out / "newton"))
        self.assertEqual(here["metrics"], there["metrics"])
        self.assertEqual(here["files"], there["files"])
        for file in there["files"]:
            self.assertTrue((self.out / "newton" / file).exists(), file)
        self.assertEqual((self.out / "newton" / "closed.obj").read_bytes(), (solved / "closed.obj").read_bytes())
        self.assertIn(b"distance_to_reference_method", (self.out / "newton" / "closed.vtp").read_bytes())
        self.assertNotIn(b"distance_to_reference_method", (self.out / "lbfgs" / "closed.vtp").read_bytes())
        page = (self.out / "compare.html").read_text()
        self.assertIn("<th scope=\"row\" class=\"plain text\">newton</th>", page)

    def test_names_the_branches_of_a_membrane_that_resists_compression(self):
        scene = self.valve("--membrane", "stvk", triangles=625)
        text, found, _ = self.compare(scene, "--methods", "lbfgs,newton", "--reference", "lbfgs", "--tolerance", "1e-6")
        reference, method = found["methods"]
        self.assertEqual(method["verdict"], "another branch", text)
        self.assertGreater(method["distance_to_reference_method"]["same_vertex"]["max_mm"], 0.1)
        self.assertIsNotNone(method["energy_above_reference_mj"])
        for energy in (method["energy_mj"], reference["energy_mj"]):
            self.assertIn(f"{energy:.9g} mJ", " ".join(text.split()))  # lines end between words

    def test_looks_for_other_equilibria_around_each_method(self):
        scene = self.valve()
        text, found, _ = self.compare(scene, "--methods", "newton,lbfgs", "--branches", 1)
        for method in found["methods"]:
            self.assertEqual(method["branches"]["starts"], 2)
            self.assertIn("; other equilibria: " + method["branches"]["message"], method["message"])
            self.assertIn(method["message"], " ".join(text.split()))
            result = json.loads((self.out / method["name"] / "result.json").read_text())
            self.assertEqual(result["branches"], method["branches"])
        self.assertIsNone(self.compare(scene, "--methods", "newton")[1]["methods"][0]["branches"])

    def test_a_given_closed_surface_is_a_second_yardstick(self):
        scene = self.valve()
        self.compare(scene, "--methods", "newton")
        (self.out / "newton" / "closed.obj").rename(self.folder / "closed.obj")
        text, found, rows = self.compare(scene, "--methods", "newton,lbfgs", "--closed", self.folder / "closed.obj")
        self.assertEqual(found["closed_surface"], "closed.obj")
        for method in found["methods"]:
            self.assertLess(method["distance_to_closed_surface"]["max_mm"], 1e-3)
        self.assertLess(float(rows[0]["mean_to_closed_mm"]), 1e-6)
        self.assertIn("closed", text)

    def test_says_who_did_not_converge(self):
        scene = self.valve()
        scene.write_text(scene.read_text().replace('"solver": {', '"solver": {"max_iterations": 40, '))
        text, found, rows = self.compare(scene, "--methods", "newton,lbfgs", "--damped-steps", 0, code=1)
        self.assertEqual([row["verdict"] for row in rows], ["reference", "not converged"], text)
        self.assertEqual([m["converged"] for m in found["methods"]], [True, False])
        self.assertFalse(found["converged"])
        self.assertIn("iteration limit at residual", text)

    def test_json_alone_where_it_is_asked_for(self):
        text, found, _ = self.compare(self.valve(), "--methods", "newton, lbfgs", "--json")
        self.assertEqual(json.loads(text), found)

    def test_names_all_that_cannot_be(self):
        scene = self.valve()
        run = coapt("compare", scene, "-o", self.out, "--methods", "newtn,lbfgs,lbfgs", "--reference", "bfgs",
                    "--closed", self.folder / "nowhere.obj")
        self.assert_bad_input(run, '"newtn" is not known', 'did you mean "newton"', "this build has: ", "twice",
                              '"bfgs" is not among the methods', "nowhere.obj not found")
        self.assertFalse(self.out.exists())
        self.assert_bad_input(coapt("compare", scene, "--methods", "newton,"), "--methods")
        self.assert_bad_input(coapt("compare", self.folder / "no.json"), "no.json")
        run = coapt("compare", scene, "--max-seconds", "nan")  # of usage: a hint follows the error
        self.assertEqual(run.returncode, 2, run.stdout + run.stderr)
        self.assertIn("--max-seconds", run.stderr)

    def test_refuses_a_folder_that_cannot_be_written(self):
        scene = self.valve()
        self.out.write_text("a file")
        run = coapt("compare", scene, "--methods", "newton", "-o", self.out)
        self.assert_bad_input(run, "cannot be used as the result folder")
        self.assertEqual(run.stdout, "")

    def test_a_defect_of_the_scene_is_no_row(self):
        scene = self.valve()
        (self.folder / "leaflets.obj").unlink()
        self.assert_bad_input(coapt("compare", scene, "--methods", "newton,lbfgs", "-o", self.out), "leaflets.obj")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
