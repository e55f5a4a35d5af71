// From a scene to its result folder: build, solve, measure, write.
#pragma once

#include "results/results.hpp"
#include "scene/build/in_memory.hpp"
#include "scene/file/scene.hpp"
#include "solve/run_options.hpp"

namespace coapt {

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

// As run(scene, solvers, options), with what is given. Throws InputError also for a start with another number
// of nodes or with coordinates that are not finite, for a given term that has the name of another one, and
// for given terms together with a cascade, whose coarser meshes they do not know.
RunReport run(const Scene& scene, Given given, const SolverTable& solvers, const RunOptions& options);

}  // namespace coapt
