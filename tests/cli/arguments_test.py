"""Arguments that are not understood: the nearest command or option is named, and help is a word too."""
import json
import pathlib
import shutil
import subprocess
import unittest

from command_case import CommandCase, coapt


class Arguments(CommandCase):
    def test_an_unknown_command_names_the_nearest_and_all(self):
        self.assert_bad_input(coapt("slove", "x.json"), 'there is no "slove"', 'did you mean "solve"', "register", "coapt help")

    def test_a_command_of_the_python_module_is_said_to_be_there(self):
        for words in (["kernel"], ["kernel", "Spring", "k", "--nodes", 2]):
            self.assert_bad_input(coapt(*words), "Python module", "python3 -m coapt kernel --help")

    def test_no_command_lists_them(self):
        run = coapt()
        self.assert_bad_input(run, "which?", "solve", "generate")
        self.assertRegex(run.stdout, r"(?m)^  coapt solve +Solve a scene")
        self.assertEqual(len(run.stdout.splitlines()), 21, "one line for each; `pages` is for those who pack the command")

    def test_the_nearest_value_of_a_scene_is_named(self):
        scene = self.generate("disc", "--triangles", 100)
        text = scene.read_text()
        scene.write_text(text.replace('"type": "newton"', '"type": "newtn"').replace('"cst_stvk"', '"cst_stvkk"'))
        self.assertNotEqual(scene.read_text(), text)
        for command in ("check", "solve"):
            self.assert_bad_input(coapt(command, scene), "cst_stvkk", 'did you mean "cst_stvk"')
        scene.write_text(text.replace('"type": "newton"', '"type": "newtn"'))
        self.assertNotEqual(scene.read_text(), text)
        for command in ("check", "solve"):
            self.assert_bad_input(coapt(command, scene), "newtn", 'did you mean "newton"')
        scene.write_text(text)
        self.assert_bad_input(coapt("solve", scene, "--solver", "lbfsg"), 'did you mean "lbfgs"')
        self.assert_bad_input(coapt("compare", scene, "--methods", "newton,lbfsg"), 'did you mean "lbfgs"')

    def test_man_pages_and_completions_are_sound(self):
        run = coapt("pages", self.folder / "pages", "--json")
        self.assertEqual(run.returncode, 0, run.stderr)
        written = [pathlib.Path(path) for path in json.loads(run.stdout)["written"]]
        names = {path.name for path in written}
        self.assertLessEqual({"coapt.1", "coapt-solve.1", "coapt-mesh-study.1", "coapt.bash", "_coapt"}, names)
        self.assertNotIn("coapt-pages.1", names)
        solve = (self.folder / "pages" / "coapt-solve.1").read_text()
        for piece in ("\\-\\-tolerance", ".SH EXIT STATUS", "\\fISCENE\\fR"):
            self.assertIn(piece, solve)
        for path in written:
            if path.suffix == ".1" and shutil.which("man"):
                page = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", "-Tutf8", "-Z", path],
                                      stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                self.assertEqual((page.returncode, page.stderr), (0, ""), path.name)
        if shutil.which("zsh"):
            self.assertEqual(subprocess.run(["zsh", "-n", self.folder / "pages" / "_coapt"]).returncode, 0)
        bash = self.folder / "pages" / "coapt.bash"
        self.assertEqual(subprocess.run(["bash", "-n", bash]).returncode, 0)

        def completed(*words):
            script = (f'source "{bash}"; COMP_WORDS=({" ".join(map(repr, words))}); COMP_CWORD={len(words) - 1}; '
                      '_coapt; printf "%s\n" "${COMPREPLY[@]}"')
            return subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True).stdout.split()

        self.assertEqual(completed("coapt", "sol"), ["solve"])
        self.assertEqual(completed("coapt", "solve", "--tol"), ["--tolerance"])
        self.assertEqual(completed("coapt", "generate", "disc", "--contact", "ba"), ["barrier"])

    def test_an_unknown_option_names_the_nearest(self):
        self.assert_bad_input(coapt("solve", "x.json", "--solvr", "newton"), "coapt solve: there is no option --solvr",
                              'did you mean "--solver"')
        self.assert_bad_input(coapt("solve", "x.json", "--solvr=newton"), "no option --solvr;")
        self.assert_bad_input(coapt("solve", "--solver", "newton"), "coapt solve: ", "SCENE")

    def test_an_unknown_value_of_an_option_names_the_nearest(self):
        into = ("-o", self.folder / "out")
        for arguments, option, meant in [(("generate", "mitral", "--membrane", "tension_feild", *into), "--membrane", "tension_field"),
                                         (("generate", "mitral", "--contact=barier", *into), "--contact", "barrier"),
                                         (("generate", "mitral", "--preset", "closd", *into), "--preset", "closed"),
                                         (("generate", "mitral", "--model", "hamer-2011", *into), "--model", "hammer-2011"),
                                         (("tune", "x.json", "--sides", "targt"), "--sides", "target"),
                                         (("schema", "scen"), "WHICH", "scene")]:
            with self.subTest(arguments):
                self.assert_bad_input(coapt(*arguments), option, f'did you mean "{meant}"?', "; there are: ")
        self.assert_bad_input(coapt("generate", "mitrl", *into), "mitrl", 'did you mean "mitral"?')
        scene = self.generate("mitral", "--triangles", 250)
        for name, meant in [("chords.lenth", "length_scale"), ("pressure.value", "load_pressure")]:
            self.assert_bad_input(coapt("sensitivity", scene, "--parameters", name), f'did you mean "{meant}"?')

    def test_a_number_that_is_none_is_told_what_it_should_be(self):
        new = self.folder / "new"
        for word in ("0.3", "-1", "many"):
            self.assert_bad_input(coapt("generate", "mitral", "--rough", word, "-o", new),
                                  f"--rough: '{word}' is not a whole number, 0 or greater")
        self.assert_bad_input(coapt("solve", "scene.json", "--checkpoint-every", "soon"),
                              "--checkpoint-every: 'soon' is not a number")
        self.assert_bad_input(coapt("generate", "mitral", "--rough", 5000000000, "-o", new), "--rough: 5000000000 is out of range")
        run = coapt("solve", "scene.json", "--no-report=perhaps")
        self.assertEqual(run.returncode, 2)
        self.assertNotIn("is not a number", run.stderr)
        self.assertFalse(new.exists())

    def test_help_of_an_unknown_command_names_the_nearest(self):
        for words in ("help", "slve"), ("slve", "--help"):
            self.assert_bad_input(coapt(*words), 'there is no "slve"', 'did you mean "solve"')
        self.assert_bad_input(coapt("help", "image", "convrt"), 'there is no "convrt"', 'did you mean "convert"')

    def test_help_is_a_word(self):
        for words in (("help",), ("--help",)):
            run = coapt(*words)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertIn("generate", run.stdout)
        run = coapt("help", "solve")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertIn("--max-seconds", run.stdout)


if __name__ == "__main__":
    unittest.main(argv=[__file__])
