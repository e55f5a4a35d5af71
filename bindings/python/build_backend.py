"""Builds the wheel and the archive of sources for pip and its likes (PEP 517), with CMake and the standard library.

Settings (`pip wheel --config-settings KEY=VALUE`): `build-dir` is the folder to build in, by default build/wheel-cpXY of the sources;
any other key is a variable of CMake, such as COAPT_WITH_METIS=OFF.
"""
import importlib.util
import io
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
MADE_AT_THE_TOP, MADE_ANYWHERE = {"build", "out"}, {"node_modules", "__pycache__"}


def get_requires_for_build_wheel(config_settings=None) -> list[str]:
    """What the system does not have; compiler, Eigen and nlohmann-json must come from it."""
    needs = [need for need, program in (("cmake>=3.25", "cmake"), ("ninja", "ninja")) if not shutil.which(program)]
    places = [pathlib.Path(prefix, folder, "cmake/pybind11")
              for prefix in ("/usr", "/usr/local", "/opt/homebrew") for folder in ("lib", "lib64", "share")]
    return needs if any(place.is_dir() for place in places) else [*needs, "pybind11>=2.10"]


def pybind11_of_python() -> list[str]:
    """Where pip has put pybind11; where it has not, CMake looks for the system's."""
    if not importlib.util.find_spec("pybind11"):
        return []
    import pybind11
    return [f"-Dpybind11_DIR={pybind11.get_cmake_dir()}"]


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None) -> str:
    settings = dict(config_settings or {})
    default = SOURCE / f"build/wheel-cp{sys.version_info.major}{sys.version_info.minor}"
    build = pathlib.Path(settings.pop("build-dir", default))
    variables = [f"-D{name}={value}" for name, value in settings.items()]
    subprocess.run(["cmake", "--preset", "portable", "-B", build, f"-DPython_EXECUTABLE={sys.executable}", "-DCOAPT_WITH_PYTHON=ON",
                    *pybind11_of_python(), *variables], cwd=SOURCE, check=True)
    shutil.rmtree(build / "wheels", ignore_errors=True)
    subprocess.run(["cmake", "--build", build, "--target", "wheel"], cwd=SOURCE, check=True)
    wheel, = (build / "wheels").glob("coapt-*.whl")
    return pathlib.Path(shutil.copy(wheel, wheel_directory)).name


def sources() -> list[pathlib.Path]:
    """The files under version control, or all where there is none, as in an archive of sources."""
    if (SOURCE / ".git").exists():
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=SOURCE, capture_output=True, text=True, check=True).stdout
        return [SOURCE / name for name in listed.split("\0") if name and (SOURCE / name).is_file()]
    files = {path.relative_to(SOURCE): path for path in SOURCE.rglob("*") if path.is_file() and path.name != "PKG-INFO"}
    return [path for name, path in sorted(files.items())
            if name.parts[0] not in MADE_AT_THE_TOP and not MADE_ANYWHERE & set(name.parts)]


def build_sdist(sdist_directory, config_settings=None) -> str:
    version = re.search(r"^project\(coapt VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text(), re.MULTILINE)[1]
    name = f"coapt-{version}"
    about = f"Metadata-Version: 2.1\nName: coapt\nVersion: {version}\n".encode()
    with tarfile.open(pathlib.Path(sdist_directory, f"{name}.tar.gz"), "w:gz") as archive:
        for path in sources():
            archive.add(path, f"{name}/{path.relative_to(SOURCE)}")
        entry = tarfile.TarInfo(f"{name}/PKG-INFO")
        entry.size = len(about)
        archive.addfile(entry, io.BytesIO(about))
    return f"{name}.tar.gz"
