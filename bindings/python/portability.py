"""Which systems a compiled module of Linux runs on: the C library that it asks for, and nothing besides."""
import pathlib
import platform
import re
import subprocess

# Every glibc has them. A portable file takes the runtime of C++ in, so that no older one can be in its way.
OF_THE_SYSTEM = re.compile(r"(libc|libm|libpthread|libdl|librt|ld-linux-[\w-]+)\.so\.\d+")


def objdump(option: str, file: pathlib.Path) -> str:
    return subprocess.run(["objdump", option, str(file)], capture_output=True, text=True, check=True).stdout


def needed(file: pathlib.Path) -> list[str]:
    """The shared libraries that the file names."""
    return re.findall(r"^\s+NEEDED\s+(\S+)$", objdump("-p", file), re.MULTILINE)


def glibc(file: pathlib.Path) -> tuple[int, int]:
    """The oldest release of the GNU C library that has every symbol which the file asks for."""
    versions = re.findall(r"\(?GLIBC_(\d+)\.(\d+)", objdump("-T", file))
    return max((int(major), int(minor)) for major, minor in versions)


def manylinux(file: pathlib.Path, newest: str) -> str:
    """The tag of platform that the file deserves (PEP 600), such as manylinux_2_35_x86_64.

    Ends the program where the file loads what not every system has, or needs a C library newer than `newest`.
    """
    others = [name for name in needed(file) if not OF_THE_SYSTEM.fullmatch(name)]
    if others:
        raise SystemExit(f"{file}: loads {', '.join(others)}, so it is not portable; configure with -DCOAPT_PORTABLE=ON")
    major, minor = glibc(file)
    if (major, minor) > tuple(int(part) for part in newest.split(".")):
        raise SystemExit(f"{file}: needs glibc {major}.{minor}, newer than {newest}; build it on an older system")
    return f"manylinux_{major}_{minor}_{platform.machine()}"
