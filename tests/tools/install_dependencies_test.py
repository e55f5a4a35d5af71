"""scripts/install-dependencies with stand-ins of apt, dpkg, id and sudo: what it says, and what it asks apt for.

    install_dependencies_test.py SOURCE
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(sys.argv[1], "scripts/install-dependencies")
APT = """#!/bin/bash
echo "$@" >> "$CALLS"
case "$*" in
  update*) echo "Get:1 the list of packages" ;;
  *assume-no*) echo "Need to get 12.3 MB of archives." ;;
  *) echo "Reading package lists..."; for k in 1 2 3 4 5; do echo "Unpacking part $k"; done; exit "${APT_EXIT:-0}" ;;
esac
"""


class InstallDependencies(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="coapt-dependencies-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        for name in ("bash", "dirname", "env", "grep"):
            (self.folder / name).symlink_to(shutil.which(name))
        self.stand_in("dpkg-query", "#!/bin/bash\nexit 1\n")  # nothing is installed
        self.stand_in("apt-get", APT)

    def stand_in(self, name: str, text: str) -> None:
        (self.folder / name).write_text(text)
        (self.folder / name).chmod(0o755)

    def run_script(self, user: int, what: str = "minimal", **environment: str) -> subprocess.CompletedProcess:
        self.stand_in("id", f"#!/bin/bash\necho {user}\n")
        calls = self.folder / "calls"
        calls.touch()
        done = subprocess.run([SCRIPT, what], capture_output=True, text=True,
                              env={"PATH": str(self.folder), "CALLS": str(calls), **environment})
        self.calls = calls.read_text()
        return done

    def test_without_root_and_sudo_it_says_what_root_is_to_run(self):
        done = self.run_script(1000)
        self.assertEqual(done.returncode, 1)
        self.assertIn("sudo: command not found, and you are not root", done.stderr)
        self.assertRegex(done.stderr, "apt-get install --no-install-recommends .*libeigen3-dev")
        self.assertEqual(self.calls, "")

    def test_with_sudo_it_asks_sudo(self):
        self.stand_in("sudo", '#!/bin/bash\necho "sudo $1" >> "$CALLS"\nexec "$@"\n')
        self.assertEqual(self.run_script(1000).returncode, 0)
        self.assertIn("sudo apt-get\nupdate", self.calls)

    def test_apt_is_heard_of_from_the_first_step_on(self):
        done = self.run_script(0)
        self.assertEqual(done.returncode, 0, done.stderr)
        before, after = done.stdout.split("Need to get 12.3 MB of archives.")
        self.assertIn("Get:1 the list of packages", before)
        self.assertIn("Unpacking part 1", after)
        self.assertLess(after.count("Unpacking"), 5)  # one line in five seconds
        self.assertNotIn("Reading", after)

    def test_the_demo_asks_for_less_than_the_command(self):
        self.stand_in("npm", "#!/bin/bash\n")
        wanted = {}
        for what in ("demo", "build"):
            self.assertEqual(self.run_script(0, what).returncode, 0)
            wanted[what] = set(self.calls.splitlines()[-1].split())
        self.assertLess(wanted["demo"], wanted["build"])
        self.assertFalse(wanted["demo"] & {"libcgal-dev", "libceres-dev", "libsuitesparse-dev", "libcli11-dev"})

    def test_what_apt_cannot_install_is_an_error(self):
        self.assertNotEqual(self.run_script(0, APT_EXIT="100").returncode, 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
