// What a user wants to know of a benchmark: how long it takes to a wanted accuracy, by which method on which
// mesh, and how the time grows with the mesh.
#pragma once

#include "study/bench/benchmark.hpp"

#include <array>

namespace coapt {

enum class ErrorKind {
  Algebraic,  // the greatest, on the run's own mesh
  Total       // see RunErrors
};

// Accuracies that times are given for [mm]. The last of the algebraic ones is far below what a mesh leaves.
inline constexpr std::array kTotalAccuracies{1.0, 0.1, 0.01};
inline constexpr std::array kAlgebraicAccuracies{1.0, 0.1, 0.01, 1e-6};

// Empty where it is not known [mm].
std::optional<double> error_of(const BenchRun& run, ErrorKind kind);

// CPU time of a run in units of BenchMesh::factorisation_s; empty where that is not known.
std::optional<double> factorisations_worth(const Benchmark& bench, const BenchRun& run);

// Which runs are asked; empty: all.
struct RunFilter {
  std::optional<size_t> method = {}, mesh = {};
};

// Of the converged runs whose error is at most `mm` the one with the least median wall time; null where there
// is none. A run that stopped early is never it: without the benchmark nobody would know its error.
const BenchRun* fastest_run(const Benchmark& bench, ErrorKind kind, double mm, const RunFilter& filter = {});

// Of the converged runs the one with the least error; null where none is known.
const BenchRun* most_exact_run(const Benchmark& bench, ErrorKind kind);

// p of time ~ triangles^p, of the best CPU times at the tightest tolerance that the method reached on the
// most meshes (wall times of a shared machine show its other users); least squares over the meshes. Empty
// with fewer than two.
struct Growth {
  double exponent = 0;
  double tolerance = 0;
  int meshes = 0;
};
std::optional<Growth> growth(const Benchmark& bench, size_t method);

// In the form "for MM mm on this scene: SOLVER, N triangles, S s (tolerance T, error E mm)"; where no run is
// that exact the most exact one, and whether a finer mesh or a tighter tolerance is what it lacks; where no
// error is known, why.
std::string recommendation(const Benchmark& bench, double mm);

// "the equilibrium of newton on 10,080 triangles was not found: ...": what errors could not be measured to,
// first the reference method's, mesh by mesh; without those the error of the mesh is known less well, or not
// at all. Then those of the other methods.
std::vector<std::string> missing_equilibria(const Benchmark& bench);

// "2,500 triangles", or nodes in a scene without a mesh.
std::string mesh_text(const BenchMesh& mesh);

// What is in doubt about the equilibrium that the page shows; empty where nothing is, or none is shown.
std::string doubts_of_shown(const Benchmark& bench);

// Methods that ended in another equilibrium than the reference method, and what a search around that one
// found.
std::vector<std::string> other_equilibria(const Benchmark& bench);

}  // namespace coapt
