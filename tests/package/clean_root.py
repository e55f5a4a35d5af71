"""A folder with the files of some of this machine's Debian packages, of all that these depend on, and nothing else.

A program that runs in it by chroot finds what its packages promise. Nothing is downloaded: packages that are not
installed here are left out, and whoever needs them fails.
"""
import functools
import os
import pathlib
import re
import shutil
import stat
import subprocess

# Nothing runs or loads these; compilers read the headers.
PAPERS = re.compile(r"/usr/share/(doc|info|lintian|locale|man)/")
LEFT_OUT = re.compile(rf"/usr/include/|{PAPERS.pattern}")


def run(*command, **options) -> str:
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\nexit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def chroot(root: pathlib.Path, *command, environment: dict[str, str] | None = None) -> str:
    """Runs the command in the root with this environment alone, none unless it is given."""
    return run("/usr/sbin/chroot", root, *command, env=environment or {})


def names_in(choices: str) -> list[str]:
    return [re.split(r"[ (:]", choice.strip())[0] for choice in choices.split("|") if choice.strip()]


@functools.cache
def installed() -> tuple[dict[str, str], dict[str, list[str]]]:
    """What each package of this machine depends on; the packages behind a name, the one that is called so first."""
    fields = "${db:Status-Status}\t${Package}\t${Depends}, ${Pre-Depends}\t${Provides}\n"
    lines = [line.split("\t") for line in run("dpkg-query", "-W", "-f", fields).splitlines()]
    table = [line[1:] for line in lines if line[0] == "installed"]
    behind = {package: [package] for package, _, _ in table}
    for package, _, provides in table:
        for name in (name for part in provides.split(",") for name in names_in(part)):
            behind.setdefault(name, []).append(package)
    return {package: depends for package, depends, _ in table}, behind


def closure(relation: str, every_choice: bool = False) -> set[str]:
    """The packages of this machine that fulfil it and what they depend on; of several choices the first, or all."""
    depends, behind = installed()
    found, wanted = set(), [relation]
    while wanted:
        for choices in wanted.pop().split(","):
            packages = [package for name in names_in(choices) for package in behind.get(name, [])]
            new = set(packages if every_choice else packages[:1]) - found
            found |= new
            wanted += [depends[package] for package in new]
    return found


def make_database(root: pathlib.Path, relation: str) -> None:
    """For dpkg --root: the packages of the closure are installed, without their lists of files."""
    database = root / "var/lib/dpkg"
    for name in ("info", "updates", "triggers"):
        (database / name).mkdir(parents=True, exist_ok=True)
    (database / "status").write_text(run("dpkg-query", "-s", *sorted(closure(relation))))


def copy_files(root: pathlib.Path, packages: set[str], left_out: re.Pattern) -> None:
    for name in ("bin", "lib", "lib32", "lib64", "libx32", "sbin"):
        link = pathlib.Path("/", name)
        if link.is_symlink():  # merged /usr: many packages still name their files by the link
            (root / link.readlink()).mkdir(parents=True, exist_ok=True)
            (root / name).symlink_to(link.readlink())
    for path in run("dpkg-query", "-L", *sorted(packages)).splitlines():
        copy = root / path.lstrip("/")
        if not path.startswith("/") or left_out.match(path) or os.path.lexists(copy):
            continue  # "diverted by ...", a folder of several packages
        if os.path.isdir(path) and not os.path.islink(path):
            copy.mkdir(parents=True)
        elif os.path.lexists(path):
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(path, copy, follow_symlinks=False)


def make_links(root: pathlib.Path) -> None:
    """What the scripts of the packages do at installation: choices such as libblas.so.3, and the loader's cache."""
    choices = pathlib.Path("/var/lib/dpkg/alternatives")
    shutil.copytree(choices, root / "var/lib/dpkg/alternatives", dirs_exist_ok=True)
    (root / "etc/alternatives").mkdir(parents=True, exist_ok=True)
    for choice in choices.iterdir():  # takes the best of those whose files are in the root; none is no error
        run("/usr/bin/update-alternatives", "--root", root, "--auto", choice.name)
    run("/sbin/ldconfig", "-r", root)


def make(root: pathlib.Path, relation: str, left_out: re.Pattern = LEFT_OUT) -> None:
    """Makes the root for a relation as in the field Depends; the caller is root."""
    make_database(root, relation)
    copy_files(root, closure(relation), left_out)
    make_links(root)
    (root / "tmp").mkdir(exist_ok=True)
    (root / "tmp").chmod(0o1777)
    (root / "dev").mkdir(exist_ok=True)
    for name in ("null", "urandom"):
        try:
            os.mknod(root / "dev" / name, 0o666 | stat.S_IFCHR, os.stat(f"/dev/{name}").st_rdev)
        except PermissionError:  # root of a container alone: a file will do to throw things away
            (root / "dev" / name).touch()
