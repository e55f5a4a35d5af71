"""docs/benchmarks.md is what bench/tables.py makes of bench/results, and the program finds what is wrong with data."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
import tables  # noqa: E402

DATA = "# date: 2026-11-21\n# machine: fast\n# command: bench/x\n# note: Best of three.\ncase,triangles\nvalve,2490\n"


class BenchmarkTables(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.results = pathlib.Path(folder.name)
        self.write("machines", "# date: 2026-11-21\n# machine: any\n# made: by hand\nmachine,what it is\nfast,a computer\n")

    def write(self, name: str, text: str):
        (self.results / name).parent.mkdir(exist_ok=True)
        (self.results / f"{name}.csv").write_text(text, encoding="utf-8")

    def text(self, *names: str) -> tuple[str, list[str]]:
        page = "".join(f"<!-- table {name} -->\nold\n<!-- end -->\n" for name in ("machines", *names))
        return tables.page_text(page, self.results)

    def test_the_page_is_up_to_date(self):
        run = subprocess.run([sys.executable, "-B", str(ROOT / "bench/tables.py"), "--check"], capture_output=True, text=True)
        self.assertEqual(run.returncode, 0, run.stdout)

    def test_every_table_of_figures_comes_from_data(self):
        rest = tables.MARKED.sub("", tables.PAGE.read_text(encoding="utf-8"))
        heads = [a for a, b in zip(rest.splitlines(), rest.splitlines()[1:]) if b.startswith("|---")]
        self.assertEqual(heads, ["| feature that is off | what the tests hold |", "| subject | decision |"])

    def test_writes_the_table_with_date_machine_and_command(self):
        self.write("solves", DATA)
        text, found = self.text("solves")
        self.assertEqual(found, [])
        self.assertIn("| case | triangles |\n|---|---|\n| valve | 2,490 |\n\n*2026-11-21, fast*, `bench/x`. Best of three.\n", text)
        self.assertNotIn("old", text)

    def test_finds_data_in_folders_and_says_by_what_they_were_made(self):
        self.write("solves/valves", DATA.replace("command: bench/x", "made: by hand"))
        text, found = self.text("valves")
        self.assertEqual(found, [])
        self.assertIn("*2026-11-21, fast*, by hand. Best of three.\n", text)
        self.write("rows/solves", "a,b\n1,2\n")  # of single solves: no table
        self.assertEqual(self.text("valves")[1], [])

    def test_names_what_is_wrong_with_data(self):
        for broken, word in ((DATA.replace("# date: 2026-11-21\n", ""), "no date"), (DATA.replace("fast", "slow"), "slow"),
                             (DATA + "disc\n", "lengths"), (DATA.replace("11-21", "yesterday"), "yesterday"),
                             (DATA.replace("# note", "# notes"), "notes"), (DATA.replace("# command: bench/x\n", ""), "no command")):
            self.write("solves", broken)
            _, found = self.text("solves")
            self.assertEqual(len(found), 1, found)
            self.assertIn(word, found[0])

    def test_names_data_without_a_table_and_a_table_without_data(self):
        self.write("solves", DATA)
        _, found = self.text("other")
        self.assertEqual(len(found), 2, found)

    def test_every_paper_with_data_has_a_page(self):
        found = tables.in_order(tables.PAPERS / "nobody-1900.md", self.results, True)
        self.assertEqual(len(found), 1)
        self.assertIn("docs/papers/nobody-1900.md", found[0])
        self.assertTrue(list((tables.RESULTS / "papers").iterdir()))

    def test_records_what_a_benchmark_prints(self):
        printed = "words\n| case | CPU s |\n|---|---|\n| a, b | 2,490 |\n"
        data = tables.recorded(printed, {"date": "2026-11-21", "machine": "fast"})
        self.assertEqual(data, '# date: 2026-11-21\n# machine: fast\ncase,CPU s\n"a, b",2490\n')


if __name__ == "__main__":
    unittest.main()
