"""tools/same_numbers.py finds what differs, be it the last digit, and passes what differs in times alone.

    same_numbers_test.py [COAPT]     with a command: it gives the same numbers as itself
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
COAPT = sys.argv.pop(1) if len(sys.argv) > 1 else None
PROGRAM = """#!{python}
import json, pathlib, sys
files = json.loads({files!r})
folder = pathlib.Path(sys.argv[sys.argv.index("-o") + 1])
folder.mkdir()
for name, text in files.items():
    (folder / name).write_text(text)
sys.exit({code})
"""
RESULT = {"status": "converged", "residual": 0.1, "time": {"wall_s": 1.0, "by_phase": {"gradient": 0.5}}, "peak_memory_mb": 3,
          "trace": [{"residual": 1.0}], "rows": [{"unit": "s", "figure": 0.01, "message": "0.01 s late"},
                   {"status": "time_limit", "iterations": 9, "message": "stopped"}, {"status": "converged", "message": "9 iterates in 0.2 s"}]}
FILES = {"closed.obj": "v 0 0 1\nv 1 0 1\n", "metrics.csv": "metric,value,unit\norifice,0.1,mm2\n",
         "trace.csv": "iteration,energy_mj,seconds\n0,1.5,0.001\n", "result.json": json.dumps(RESULT), "report.html": "a"}


class SameNumbers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "scene.json").write_text("{}", encoding="utf-8")

    def program(self, name: str, code: int = 0, **changed: str | None) -> str:
        """A command that writes FILES, with changes by their names without suffix; None leaves a file out."""
        files = {file: changed.get(file.split(".")[0], text) for file, text in FILES.items()}
        text = PROGRAM.format(python=sys.executable, code=code,
                              files=json.dumps({file: text for file, text in files.items() if text is not None}))
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        path.chmod(0o755)
        return str(path)

    def compared(self, *words: str) -> tuple[int, str]:
        run = subprocess.run([sys.executable, "-B", str(ROOT / "tools/same_numbers.py"), *words], capture_output=True, text=True)
        return run.returncode, run.stdout + run.stderr

    def with_change(self, code: int = 0, **changed: str | None) -> tuple[int, str]:
        return self.compared(self.program("before"), self.program("after", code, **changed), str(self.folder / "scene.json"))

    def result(self, **changed: object) -> str:
        return json.dumps({**RESULT, **changed})

    def test_passes_where_times_memory_and_pages_differ_alone(self):
        rows = [{"unit": "s", "figure": 0.03, "message": "0.03 s late"}, {"status": "time_limit", "iterations": 8, "message": "ended"},
                {"status": "converged", "message": "9 iterates in 3e-05 s"}]
        code, said = self.with_change(report="b", trace="iteration,energy_mj,seconds\n0,1.5,0.002\n",
                                      result=self.result(time={"wall_s": 2.0}, peak_memory_mb=4, rows=rows))
        self.assertEqual(code, 0, said)
        self.assertIn("2 the same to the last digit", said)  # the scene and stress --quick

    def test_finds_a_difference_of_the_last_digit(self):
        for changed, place in (({"closed": "v 0 0 1\nv 1 0 1.0000000000000002\n"}, "closed.obj: line 2: v 1 0 1, then v 1 0 1.0000000000000002"),
                               ({"metrics": "metric,value,unit\norifice,0.10000000000000002,mm2\n"}, "metrics.csv: row 1"),
                               ({"trace": "iteration,energy_mj,seconds\n0,1.6,0.001\n"}, "trace.csv: row 1: 0,1.5, then 0,1.6"),
                               ({"result": self.result(residual=0.10000000000000002)}, "result.json: residual: 0.1, then 0.10000000000000002"),
                               ({"result": self.result(rows=[*RESULT["rows"][:2], {"status": "converged", "message": "8 iterates in 0.2 s"}])}, "rows[2].message"),
                               ({"result": self.result(trace=[{"residual": 2.0}])}, "result.json: trace[0].residual: 1.0, then 2.0")):
            code, said = self.with_change(**changed)
            self.assertEqual(code, 1, said)
            self.assertIn(place, said)
            self.assertIn("2 of 2 differ", said)

    def test_finds_a_file_a_value_and_an_exit_code_that_one_of_both_has(self):
        for changed, place in (({"closed": None}, "closed.obj: is written by BEFORE alone"), ({"code": 4}, "exit code 0, then 4"),
                               ({"metrics": FILES["metrics.csv"] + "tenting,1,mm3\n"}, "row 2: nothing, then tenting,1,mm3"),
                               ({"result": self.result(warnings=["a"])}, 'warnings[0]: nothing, then "a"')):
            code, said = self.with_change(**changed)
            self.assertEqual(code, 1, said)
            self.assertIn(place, said)

    def test_programs_that_write_nothing_are_not_the_same(self):
        empty = {name.split(".")[0]: None for name in FILES}
        code, said = self.compared(self.program("before", 2, **empty), self.program("after", 2, **empty), str(self.folder / "scene.json"))
        self.assertEqual(code, 1, said)
        self.assertIn("neither program wrote anything", said)

    def test_names_a_program_that_is_not_there(self):
        code, said = self.compared(str(self.folder / "nothing"), self.program("after"))
        self.assertEqual(code, 2)
        self.assertIn("nothing: no such file", said)

    @unittest.skipUnless(COAPT, "no command is given")
    def test_a_command_gives_its_own_numbers_again(self):
        scenes = [str(ROOT / f"examples/{name}/scene.json") for name in ("02_pressurised_disc", "03_catenary")]
        code, said = self.compared(COAPT, COAPT, "--no-stress", *scenes)
        self.assertEqual(code, 0, said)
        self.assertIn("2 the same to the last digit", said)


if __name__ == "__main__":
    unittest.main()
