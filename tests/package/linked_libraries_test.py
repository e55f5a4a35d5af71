"""A program needs the libraries of the components that its build has, and of the language; no other.

    linked_libraries_test.py PROGRAM [COMPONENT...]      components as in COAPT_WITH_..., those that it may use
"""
import re
import subprocess
import sys

RUNTIME = {"libstdc++", "libm", "libgcc_s", "libc", "libpthread", "libdl", "ld-linux-x86-64", "ld-linux-aarch64"}
COMPONENTS = {"PUGIXML": {"libpugixml"}, "ZLIB": {"libz"}, "NLOPT": {"libnlopt"}, "OPENBLAS": {"libopenblas"},
              "CHOLMOD": {"libcholmod"}, "CGAL": {"libgmp", "libmpfr"}, "METIS": {"libmetis"}}
# Debian's Ceres names all that it was built with; the linker keeps what is used.
CERES = {"libceres", "libglog", "libgflags", "libspqr", "libcholmod", "libccolamd", "libcamd", "libcolamd", "libamd",
         "libcxsparse", "libsuitesparseconfig", "liblapack", "libblas", "libf77blas", "libatlas", "libunwind", "libtbb",
         "libmetis"}


ITK = re.compile(r"lib(ITK|itk|gdcm)")  # one library for each of its modules


def needed(program: str) -> set[str]:
    text = subprocess.run(["readelf", "--dynamic", "--wide", program], capture_output=True, text=True, check=True).stdout
    return {re.sub(r"\.so.*", "", name) for name in re.findall(r"\(NEEDED\).*\[(.*)\]", text)}


def main() -> int:
    program, *present = sys.argv[1:]
    found, allowed = needed(program), set(RUNTIME)
    for component in present:
        allowed |= CERES if component == "CERES" else COMPONENTS.get(component, set())
    if "ITK" in present:
        allowed |= {name for name in found if ITK.match(name)}
    print(f"{program} needs {', '.join(sorted(found))}")
    if "libstdc++" not in found:
        print("not a program of C++ that was linked dynamically: nothing is shown by it")
        return 1
    for name in sorted(found - allowed):
        print(f"FAILED: {name} belongs to none of: the language, {', '.join(present) or 'no component'}")
    return 1 if found - allowed else 0


if __name__ == "__main__":
    sys.exit(main())
