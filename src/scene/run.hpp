// From a scene to its result folder: build, solve, measure, write.
#pragma once

#include "scene/results.hpp"
#include "scene/scene.hpp"

#include <optional>

namespace coapt {

struct RunOptions {
  std::string solver;                 // empty: the scene's
  std::optional<double> tolerance;    // empty: the scene's
  std::optional<double> max_seconds;  // empty: the scene's
  std::optional<int> modes;           // smallest eigenvalues in the certificate; empty: the scene's
  std::optional<int> frame_interval;  // accepted iterates from frame to frame, at least 1; empty: the scene's
  std::optional<bool> writes_page;    // report.html; empty: as the scene says
  std::filesystem::path folder;       // empty: the scene's, see result_folder()
  bool writes = true;                 // false: measures only
  Observer observer;                  // may be empty

  // Those of the build; a scene that leaves the choice open gets "cholmod" where it is there.
  FactorisationTable factorisations = {{"eigen", make_eigen_factorisation}};
  IntersectionJudge judge;  // of the result
};

struct RunReport {
  Model model;
  Report report;
  std::filesystem::path folder;  // empty: nothing was written
};

// Where results go unless something else is asked for: the scene's output folder, or `result` beside the
// scene file.
std::filesystem::path result_folder(const Scene& scene);

// Solves the scene. Results are written whatever the status: also those of a run that did not converge or
// was cancelled. Throws InputError for bad input, an unknown solver (listing those in the table), or a
// folder that cannot be written, before the solve.
RunReport run(const Scene& scene, const SolverTable& solvers, const RunOptions& options = {});

}  // namespace coapt
