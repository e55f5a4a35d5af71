"""Arguments that are not understood: the nearest command or option is named, and help is a word too."""
import unittest

from command_case import CommandCase, coapt


class Arguments(CommandCase):
    def test_an_unknown_command_names_the_nearest_and_all(self):
        self.assert_bad_input(coapt("slove", "x.json"), 'there is no "slove"', 'did you mean "solve"', "register", "coapt help")

    def test_no_command_lists_them(self):
        self.assert_bad_input(coapt(), "which?", "solve", "generate")

    def test_an_unknown_option_names_the_nearest(self):
        self.assert_bad_input(coapt("solve", "x.json", "--solvr", "newton"), "coapt solve: there is no option --solvr",
                              'did you mean "--solver"')
        self.assert_bad_input(coapt("solve", "x.json", "--solvr=newton"), "no option --solvr;")
        self.assert_bad_input(coapt("solve", "--solver", "newton"), "coapt solve: ", "SCENE")

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
