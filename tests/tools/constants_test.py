"""docs/constants.md is what the sources say, and the program finds a constant of which nobody says what it is."""
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import constants  # noqa: E402


class Constants(unittest.TestCase):
    def found(self, text: str):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "src/optim/one.cpp"
            path.parent.mkdir(parents=True)
            path.write_text(text, encoding="utf-8")
            return [each[1:] for each in constants.constants(pathlib.Path(folder))]

    def test_the_page_is_up_to_date(self):
        run = subprocess.run([sys.executable, "-B", str(ROOT / "tools/constants.py"), "--check"],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stdout)

    def test_every_constant_of_the_solvers_is_on_it(self):
        names = {(file, name) for file, name, _, _ in constants.constants(ROOT)}
        for each in (("optim/newton.cpp", "kFirstShift"), ("optim/dynamic/dynamic.cpp", "kMostApproach"),
                     ("energy/contact_barrier.cpp", "kKeptDistance"), ("solve/cascade.cpp", "kMostResidual"),
                     ("run/branches.cpp", "kSameState"), ("tuning/region_tuning.cpp", "kOrificeShare"), ("xpbd/contact.cpp", "kCorrection"),
                     ("registration/register_surfaces.cpp", "kBest"), ("mesh/remesh/coarsen.cpp", "kLongest"), ("linear/lowest_eigenvalues.cpp", "kChange")):
            self.assertIn(each, names)

    def test_reads_comments_behind_above_and_over_several_lines(self):
        self.assertEqual(self.found("constexpr double kA = 1e-3;  // of the force,\n"
                                    "                             // and more\n"
                                    "// Iterations,\n// in a row.\nconstexpr int kB = 4;\nconstexpr int kC = f(5, 6);\n"),
                         [("kA", "1e-3", "of the force, and more"), ("kB", "4", "Iterations, in a row."),
                          ("kC", "f(5, 6)", "Iterations, in a row.")])

    def test_parts_a_comment_that_speaks_of_each_constant(self):
        self.assertEqual(self.found("static constexpr double kA = 1, kB = 2;  // of the step; of the force\n"),
                         [("kA", "1", "of the step"), ("kB", "2", "of the force")])

    def test_takes_arrays_of_numbers_and_none_of_names(self):
        self.assertEqual(self.found("constexpr std::array kA = {0.3, 3.0};  // of the step\n"
                                    "constexpr std::array kB = {Status::Converged, Status::Stalled};  // in files\n"),
                         [("kA", "{0.3, 3.0}", "of the step")])

    def test_leaves_out_what_is_no_choice(self):
        self.assertEqual(self.found('static constexpr int kNodes = 3;\nconstexpr const char* kText = "x";\n'), [])

    def test_takes_meaning_and_origin_from_the_list(self):
        found = [("optim/one.cpp", "kA", "1", ""), ("optim/one.cpp", "kB", "2", "of the step"), ("optim/one.cpp", "kC", "3", "of it")]
        origins = {"optim/one.cpp": {"kA": {"meaning": "of the force"}, "kB": "measured", "kC": {"meaning": "c", "origin": "a paper"}}}
        found = constants.with_meanings(found, origins)
        self.assertEqual([meaning for *_, meaning in found], ["of the force", "of the step", "c"])
        self.assertEqual(constants.defects(found, origins), [])
        text = constants.page(found, origins)
        for row in ("| of the force | set by hand |", "| of the step | measured |", "| c | a paper |", "on record for the value: 1 of 3"):
            self.assertIn(row, text)

    def test_the_hook_looks_at_every_folder_whose_constants_are_listed(self):
        hooks = (ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8")
        files = re.search(r"constants\.py --check.*?files: (\S+)", hooks, re.DOTALL)[1]
        for folder in constants.FOLDERS:
            self.assertRegex(f"{folder}/one.cpp", files)

    def test_names_a_constant_without_a_meaning_and_an_origin_without_a_constant(self):
        wrong = constants.defects([("optim/one.cpp", "kA", "1", "")], {"optim/one.cpp": {"kB": "measured"}})
        self.assertEqual(len(wrong), 2, wrong)
        self.assertIn("kA", wrong[0])
        self.assertIn("kB", wrong[1])


if __name__ == "__main__":
    unittest.main()
