"""Makes the wheel of a build tree, with the standard library alone and without a network.

    make_wheel.py BUILD/python LICENSE OUTPUT_FOLDER [--manylinux NEWEST_GLIBC] [--notices FOLDER]

Prints the path of the wheel. It fits the Python that runs this script and, with --manylinux, every Linux whose C library
is as new as the one that the module asks for, which must not be newer than NEWEST_GLIBC (such as 2.35); a module that
loads anything else is refused. Without it the wheel fits this machine, and METADATA names Debian's packages whose
libraries the module loads. The same files give the same bytes on machines with the same packages. The files of the
folder of notices, of what is linked in, stand beside the licence.
"""
import argparse
import base64
import hashlib
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

import portability

GIVEN = {"libc6", "libgcc-s1", "libstdc++6"}  # every C++ program needs them


def tag(module: pathlib.Path, manylinux: str | None) -> str:
    version = f"cp{sys.version_info.major}{sys.version_info.minor}"
    if manylinux:
        return f"{version}-{version}-{portability.manylinux(module, manylinux)}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    return f"{version}-{version}-{platform}"


def record_line(name: str, content: bytes) -> str:
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}"


def external_needs(module: pathlib.Path) -> list[str]:
    """The Debian packages of the libraries that the module links, as python3-coapt gets them; none without dpkg-dev."""
    if not shutil.which("dpkg-shlibdeps"):
        return []
    with tempfile.TemporaryDirectory() as folder:
        control = pathlib.Path(folder, "debian/control")  # it works in a source package alone, an empty one will do
        control.parent.mkdir()
        control.touch()
        done = subprocess.run(["dpkg-shlibdeps", "-O", "--ignore-missing-info", f"-e{module.resolve()}"], cwd=folder,
                              capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(done.stderr)
    depends = done.stdout.strip().removeprefix("shlibs:Depends=")
    return sorted({re.split(r"[ (|]", part.strip())[0] for part in depends.split(",")} - GIVEN - {""})


def licences(licence: pathlib.Path, notices: pathlib.Path | None) -> dict[str, bytes]:
    """The texts that go beside METADATA, by path."""
    files = {"LICENSE": licence.read_bytes()}
    if notices:
        files |= {f"licenses/{path.name}": path.read_bytes() for path in sorted(notices.iterdir())}
    return files


def contents(arguments: argparse.Namespace) -> tuple[str, dict[str, bytes]]:
    """Name of the wheel without extension, and its files by path."""
    tree = arguments.tree
    metadata = (tree / "METADATA").read_bytes()
    name, version = (re.search(rb"^%s: (\S+)$" % key, metadata, re.MULTILINE)[1].decode() for key in (b"Name", b"Version"))
    package = name.replace("-", "_")
    info = f"{package}-{version}.dist-info"
    modules = [path for path in (tree / package).iterdir() if path.suffix in (".so", ".pyd")]
    if len(modules) != 1:
        raise SystemExit(f"{tree / package}: holds {len(modules)} compiled modules; expected one, build it first")
    fits = tag(modules[0], arguments.manylinux)
    sources = [path for path in (tree / package).iterdir() if path.suffix in (".py", ".pyi") or path.name == "py.typed"]
    files = {f"{package}/{path.name}": path.read_bytes() for path in sorted(sources) + modules}
    needs = "" if arguments.manylinux else "".join(f"Requires-External: {need}\n" for need in external_needs(modules[0]))
    files[f"{info}/METADATA"] = metadata + needs.encode()
    files |= {f"{info}/{path}": text for path, text in licences(arguments.licence, arguments.notices).items()}
    files[f"{info}/WHEEL"] = (f"Wheel-Version: 1.0\nGenerator: coapt {version}\nRoot-Is-Purelib: false\n"
                              f"Tag: {fits}\n").encode()
    record = "".join(record_line(path, content) + "\n" for path, content in files.items())
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    return f"{package}-{version}-{fits}", files


def main() -> None:
    parser = argparse.ArgumentParser()
    for name in ("tree", "licence", "output"):
        parser.add_argument(name, type=pathlib.Path)
    parser.add_argument("--manylinux", metavar="NEWEST_GLIBC")
    parser.add_argument("--notices", type=pathlib.Path)
    arguments = parser.parse_args()
    output = arguments.output
    name, files = contents(arguments)
    output.mkdir(parents=True, exist_ok=True)
    part = output / f"{name}.whl.part"
    with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, content in files.items():
            entry = zipfile.ZipInfo(path, (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o755 if path.endswith(".so") else 0o644) << 16
            wheel.writestr(entry, content)
    print(part.rename(output / f"{name}.whl"))


if __name__ == "__main__":
    main()
