"""`python3 -m coapt kernel` writes kernels that compile and are the library's own to 1e-10."""
import os
import subprocess
import sys

import numpy as np
import pytest

import coapt
from coapt.__main__ import main
from energy_test import CORD, RUBBER
from meshes import ROOT

pytest.importorskip("sympy", reason="python3-sympy is not installed: C++ kernels from expressions are not tested")

LIBRARIES = os.environ.get("COAPT_LIBRARIES", "-lcoapt_energy -lcoapt_mesh -lcoapt_core").split(" ")


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    folder = tmp_path_factory.mktemp("kernels")
    assert main(["kernel", "Cord", CORD, "--nodes", "2", "--data", "t,r,rho", "--output", str(folder / "cord.hpp")]) == 0
    assert main(["kernel", "Rubber", RUBBER, "--nodes", "3", "--data", "X", "--data", "mu,h",
                 "--output", str(folder / "rubber.hpp")]) == 0
    compiler = [os.environ.get("COAPT_CXX", "c++"), "-std=c++20", "-O0", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    done = subprocess.run([*compiler, f"-I{folder}", f"-I{ROOT / 'src'}", "-isystem",
                           os.environ.get("COAPT_EIGEN", "/usr/include/eigen3"), ROOT / "bench/generated_kernels.cpp",
                           *LIBRARIES, "-o", folder / "program"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return folder / "program"


def evaluated(program, kind, *states):
    """Rows of ours and of the generated kernel: energy, gradient, Hessian, energy by the shorter ways."""
    text = "".join(f"{kind} {' '.join(f'{v:.17g}' for v in state.ravel())}\n" for state in states)
    done = subprocess.run([program], input=text, capture_output=True, text=True, check=True)
    rows = np.array([[float(v) for v in line.split()] for line in done.stdout.splitlines()])
    return rows[::2], rows[1::2]


def compared(rows, term, x):
    """What NumPy makes of it, in the same order."""
    return np.concatenate([[term.value(x)], term.gradient(x).ravel(), term.hessian(x)[0].ravel(), [term.value(x)] * 2])


def test_the_cord_of_the_library(program):
    generator = np.random.default_rng(3)
    states = [np.array([[0, 0, 0], length * u / np.linalg.norm(u)]) + generator.standard_normal(3)
              for length, u in zip([0.5, 1.19, 1.21, 1.5, 4], generator.standard_normal((5, 3)))]
    ours, generated = evaluated(program, "cord", *states)
    assert not ours[:2].any() and ours[2:].all(axis=1).all()  # slack, taut
    scale = np.abs(ours).max(axis=1, keepdims=True)
    assert np.abs(generated - ours).max() <= 1e-10 * max(scale.max(), 1)
    assert (np.abs(generated - ours) <= 1e-10 * np.maximum(scale, 1e-6)).all()
    term = coapt.energy(CORD, [[0, 1]], t=0.3, r=1.2, rho=0.7)
    for row, x, size in zip(ours, states, scale[:, 0]):
        assert np.abs(compared(row, term, x) - row).max() <= 1e-10 * max(size, 1e-6)


def test_the_neo_hookean_triangle_of_the_library(program):
    generator = np.random.default_rng(4)
    X = np.array([[0, 0, 0], [1, 0, 0], [0.3, 1, 0]]) + 0.1 * generator.standard_normal((6, 3, 3))
    states = np.concatenate([X, 1.2 * X + 0.2 * generator.standard_normal(X.shape)], axis=1)
    ours, generated = evaluated(program, "rubber", *states)
    assert (ours[:, 0] > 1e-3).all()
    scale = np.abs(ours).max(axis=1, keepdims=True)
    assert (np.abs(generated - ours) <= 1e-10 * scale).all()
    for row, rest, x, size in zip(ours, X, states[:, 3:], scale[:, 0]):
        term = coapt.energy(RUBBER, [[0, 1, 2]], X=rest, mu=0.33, h=0.8)
        assert np.abs(compared(row, term, x) - row).max() <= 1e-10 * size


def test_the_projected_hessian_is_that_of_an_eigenvalue_decomposition(program):
    generator = np.random.default_rng(5)
    X = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    lines = [f"cord {' '.join(map(str, length * u))} 0 0 0" for length, u in zip([0.5, 1.5, 3], np.eye(3))]
    for stretches in ([1.2, 1.2, 1], [1.2, 0.7, 1], [0.85, 0.9, 1], [0.3, 0.3, 1]):
        for _ in range(5):
            x = X * stretches + 0.05 * generator.standard_normal(X.shape)
            lines.append(f"rubber {' '.join(map(str, X.ravel()))} {' '.join(map(str, x.ravel()))}")
    done = subprocess.run([program, "projected"], input="\n".join(lines), capture_output=True, text=True, check=True)
    rows = [np.array(line.split(), float) for line in done.stdout.splitlines()]
    assert len(rows) == 2 * len(lines) and np.any(rows[2])
    for projected, decomposed in zip(rows[::2], rows[1::2]):
        assert np.abs(projected - decomposed).max() <= 1e-13 * np.abs(decomposed).max()


def test_every_kind_of_data_and_of_condition_compiles(tmp_path):
    text = ("u = transpose(columns(x1 - x0, x2 - x0)) * a; where(norm(u) < k and x0[0] > pi, dot(u, B * u), "
            "exp(-k) * sin(x0[2])) + min(x0[1], 0)**2 + max(x1[1], k)**3 + abs(x2[2] + a[0])**3")
    term = coapt.energy(text, [[0, 1, 2]], a=np.ones((1, 3)), B=np.ones((1, 2, 2)), k=2.0, role="contact")
    (tmp_path / "mixed.hpp").write_text(term.kernel("MixedUp"))
    (tmp_path / "main.cpp").write_text("""
        #include "mixed.hpp"
        #include <cstdio>
        static_assert(coapt::ElementKernel<MixedUp>);
        int main() {
          MixedUp::Vector x, g;
          MixedUp::Matrix H;
          x << 4, -1, 2, 1, 3, 2.5, -2, 1, 0.5;
          const auto rest = MixedUp::rest(Eigen::Vector3d::Ones(), Eigen::Matrix2d::Ones(), 2);
          std::printf("%.17g ", MixedUp::evaluate(rest, x, &g, &H));
          for (const double v : g) std::printf("%.17g ", v);
          for (const double v : H.reshaped()) std::printf("%.17g ", v);
        }""")
    subprocess.run([os.environ.get("COAPT_CXX", "c++"), "-std=c++20", "-O0", "-Wall", "-Wextra", "-Werror",
                    f"-I{ROOT / 'src'}", "-isystem", os.environ.get("COAPT_EIGEN", "/usr/include/eigen3"),
                    tmp_path / "main.cpp", *LIBRARIES, "-o", tmp_path / "program"], check=True)
    found = np.array(subprocess.run([tmp_path / "program"], capture_output=True, text=True, check=True).stdout.split(), float)
    x = np.array([[4, -1, 2], [1, 3, 2.5], [-2, 1, 0.5]])
    assert found[:10] == pytest.approx([term.value(x), *term.gradient(x).ravel()], rel=1e-12)
    assert found[10:] == pytest.approx(term.hessian(x).ravel(), rel=1e-12, abs=1e-12)
    assert 'kType = "mixed_up"' in term.kernel("MixedUp") and "TermRole::Contact" in term.kernel("MixedUp")


@pytest.mark.parametrize(("arguments", "piece"), [
    (["Cord", "nrm(x1)"], "did you mean 'norm'"),
    (["class", "norm(x1 - x0)"], "class: is no name in C++"),
    (["Cord", "norm(x1 - x0)", "--role", "pull"], "role: is 'pull'"),
    (["Cord", "norm(x1 - x0)", "--data", "k:0"], "--data: 'k:0' cannot be read"),
    (["Cord", "double * norm(x1 - x0)", "--data", "double"], "double: is no name in C++"),
])
def test_what_is_wrong_is_said_in_one_line(arguments, piece, capsys):
    assert main(["kernel", *arguments, "--nodes", "2"]) == 2
    error = capsys.readouterr().err
    assert piece in error and error.count("\n") == 1


def test_the_command_reads_standard_input_and_prints():
    done = subprocess.run([sys.executable, "-m", "coapt", "kernel", "Spring", "-", "--nodes", "2", "--data", "k"],
                          input="k * dot(x1 - x0, x1 - x0)\n", capture_output=True, text=True)
    assert done.returncode == 0 and "struct Spring {" in done.stdout and done.stdout.endswith("};\n"), done.stderr
