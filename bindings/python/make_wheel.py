"""Makes the wheel of a build tree, with the standard library alone and without a network.

    make_wheel.py BUILD/python LICENSE OUTPUT_FOLDER

Prints the path of the wheel. It fits the Python that runs this script and this machine, as the compiled module does;
the same files give the same bytes on machines with the same packages: METADATA names those whose libraries it loads.
"""
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

GIVEN = {"libc6", "libgcc-s1", "libstdc++6"}  # every C++ program needs them


def tag() -> str:
    version = f"cp{sys.version_info.major}{sys.version_info.minor}"
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


def contents(tree: pathlib.Path, licence: pathlib.Path) -> tuple[str, dict[str, bytes]]:
    """Name of the wheel without extension, and its files by path."""
    metadata = (tree / "METADATA").read_bytes()
    version = re.search(rb"^Version: (\S+)$", metadata, re.MULTILINE)[1].decode()
    info = f"coapt-{version}.dist-info"
    modules = [path for path in (tree / "coapt").glob("_core.*.so")]
    if len(modules) != 1:
        raise SystemExit(f"{tree / 'coapt'}: holds {len(modules)} compiled modules; expected one, build it first")
    sources = [path for path in (tree / "coapt").iterdir() if path.suffix in (".py", ".pyi") or path.name == "py.typed"]
    files = {f"coapt/{path.name}": path.read_bytes() for path in sorted(sources) + modules}
    needs = "".join(f"Requires-External: {package}\n" for package in external_needs(modules[0]))
    files[f"{info}/METADATA"] = metadata + needs.encode()
    files[f"{info}/LICENSE"] = licence.read_bytes()
    files[f"{info}/WHEEL"] = (f"Wheel-Version: 1.0\nGenerator: coapt {version}\nRoot-Is-Purelib: false\n"
                              f"Tag: {tag()}\n").encode()
    record = "".join(record_line(name, content) + "\n" for name, content in files.items())
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    return f"coapt-{version}-{tag()}", files


def main() -> None:
    tree, licence, output = (pathlib.Path(argument) for argument in sys.argv[1:4])
    name, files = contents(tree, licence)
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
