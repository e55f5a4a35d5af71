"""What is kept where a solve is interrupted, or its result folder goes away, while it runs or while sliders are made.

Usage: interrupt_test.py COAPT_BINARY [unittest arguments]
"""
import contextlib
import os
import shutil
import signal
import subprocess
import sys
import time
import unittest

from command_case import COAPT, FILES, CommandCase

WITHOUT_SLIDERS = "they were still being made when this page was written"


class InterruptTest(CommandCase):
    def start(self, scene, *options, interrupts=signal.SIG_DFL):
        """A solve that has begun. It starts with SIGINT as given, whatever the tests themselves were started with."""
        process = subprocess.Popen([COAPT, "solve", str(scene), *options], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True,
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, interrupts))
        self.addCleanup(process.kill)
        if interrupts == signal.SIG_IGN:
            process.send_signal(signal.SIGINT)  # also before the command listens
        while not (self.folder / "result").exists() and process.poll() is None:
            time.sleep(0.01)
        return process

    def test_an_interrupt_saves_the_best_state(self):
        for number in [signal.SIGINT, signal.SIGTERM]:
            shutil.rmtree(self.folder / "result", ignore_errors=True)
            process = self.start(self.generate("mitral", "--triangles", 20000), "--tolerance", "1e-14")
            process.send_signal(number)
            output = process.communicate(timeout=100)
            self.assertEqual(process.returncode, 1, output)
            self.assertEqual(self.result()["status"], "cancelled")
            written = {p.name for p in (self.folder / "result").iterdir()}
            self.assertEqual(written, set(self.result()["files"]))
            self.assertLessEqual(FILES, written)

    def test_a_signal_while_sliders_are_made_keeps_result_and_page(self):
        scene = self.generate("mitral", "--triangles", 2500, "--preset", "closed")
        page = self.folder / "result" / "report.html"
        for number in [signal.SIGINT, signal.SIGTERM, signal.SIGKILL]:
            shutil.rmtree(self.folder / "result", ignore_errors=True)
            process = self.start(scene, "--sliders")
            while not page.exists() and process.poll() is None:  # written at first without them
                time.sleep(0.005)
            process.send_signal(number)
            output = process.communicate(timeout=100)
            self.assertIn(process.returncode, [-number] if number == signal.SIGKILL else [0], output)
            self.assertTrue(self.result()["converged"])
            text = page.read_text()
            self.assertTrue(text.endswith("</html>\n"))
            if number == signal.SIGKILL:
                self.assertIn(WITHOUT_SLIDERS, text)

    def held_up_before_its_sliders(self, *options):
        """A solve whose findings meet a full pipe: its process, the reading end, what lies before in the pipe, its page."""
        scene = self.generate("mitral", "--triangles", 250)
        page = self.folder / "result" / "report.html"
        reader, writer = os.pipe()
        os.set_blocking(writer, False)
        filled = 0
        with contextlib.suppress(BlockingIOError):
            while True:
                filled += os.write(writer, b"-" * 4096)
        os.set_blocking(writer, True)
        process = subprocess.Popen([COAPT, "solve", str(scene), "--sliders", *options], stdout=writer,
                                   stderr=subprocess.PIPE, text=True)
        os.close(writer)
        self.addCleanup(process.kill)
        while not page.exists() and process.poll() is None:
            time.sleep(0.005)
        time.sleep(3)  # sliders take a tenth of that
        self.assertIsNone(process.poll())
        self.assertTrue(WITHOUT_SLIDERS in page.read_text(), "the page has its sliders already")
        return process, reader, filled, page

    def test_the_findings_are_printed_before_sliders_are_made(self):
        process, reader, filled, page = self.held_up_before_its_sliders()
        with os.fdopen(reader, "rb") as stream:
            text = stream.read()[filled:].decode()
        process.communicate(timeout=100)
        self.assertEqual(process.returncode, 0)
        self.assertFalse(WITHOUT_SLIDERS in page.read_text())
        for once in ["converged at", "  residual ", "  orifice area ", "  intersections ", "written to "]:
            self.assertEqual(text.count(once), 1, text)
        self.assertLess(text.index("  intersections "), text.index("written to "))

    def test_a_page_is_complete_though_nobody_reads_the_findings(self):
        process, reader, _, page = self.held_up_before_its_sliders()
        os.close(reader)
        process.communicate(timeout=100)
        self.assertEqual(process.returncode, -signal.SIGPIPE)
        self.assertFalse(WITHOUT_SLIDERS in page.read_text())

    def test_a_result_folder_that_goes_away_meanwhile_loses_no_findings(self):
        process, reader, filled, page = self.held_up_before_its_sliders()
        shutil.rmtree(page.parent)
        with os.fdopen(reader, "rb") as stream:
            text = stream.read()[filled:].decode()
        errors = process.communicate(timeout=100)[1]
        self.assertEqual(process.returncode, 5, errors)
        self.assertIn("report.html: cannot be written", errors)
        self.assertIn("  intersections ", text)
        self.assertNotIn("report.html", text)

    def test_SIGTERM_during_a_solve_by_several_threads_never_crashes(self):
        # METIS catches it for the whole process while it orders: 10 of 25 such runs once ended in a segmentation fault.
        scene = self.generate("mitral", "--triangles", 3000)
        for k in range(6):
            shutil.rmtree(self.folder / "result", ignore_errors=True)
            process = self.start(scene, "--tolerance", "1e-14", "--threads", "2")
            time.sleep(0.1 * k)
            process.send_signal(signal.SIGTERM)
            output = process.communicate(timeout=100)
            self.assertEqual(process.returncode, 1, output)
            self.assertEqual(self.result()["status"], "cancelled")

    def test_an_interrupt_that_the_parent_ignores_is_ignored_all_along(self):
        # As `coapt solve scene.json &` in a script. Ignored only until the command listened, it once was lost or
        # heeded depending on how busy the machine was.
        process = self.start(self.generate("mitral", "--triangles", 5000), interrupts=signal.SIG_IGN)
        process.send_signal(signal.SIGINT)
        output = process.communicate(timeout=100)
        self.assertEqual(process.returncode, 0, output)
        self.assertEqual(self.result()["status"], "converged")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[2:]])
