// The parts of run(), for studies that solve the same scene again and again.
#pragma once

#include "run/run.hpp"
#include "scene/build/groundwork.hpp"
#include "solve/solve_scene.hpp"

namespace coapt {

// What is known of a report before the solve.
void begin_report(const Scene& scene, const SolveSetup& setup, const Model& model, const RunOptions& options,
                  Report& report);

// Solves as solve_scene() does, or from `start` as solve_again(), and keeps the shapes on the way where the
// report has a page that shows them.
CascadeOutcome solve_recorded(const Scene& scene, const Groundwork& ground, Model& model, SolveSetup setup,
                              Report& report, const Points* start = nullptr);

// solve_setup(), without a certificate where it would need Hessians that are not there. Throws InputError for
// given terms together with a cascade.
SolveSetup given_setup(const Scene& scene, const Given& given, const SolverTable& solvers,
                       const RunOptions& options);

// Of the mesh that is given, which is taken out of it, or of the scene's own.
Groundwork given_ground(const Scene& scene, Given& given);

// A given start, 3 x node_count, relative to the model's origin. Throws InputError for another number of
// nodes and for coordinates that are not finite.
Points relative_start(const Eigen::Map<const Points>& start, const Model& model);

// Measures the shape of the outcome on run.model and writes run.report into run.folder where the options want
// files.
void finish_run(const SolveSetup& setup, CascadeOutcome outcome, const RunOptions& options, RunReport& run);

// The files of the result and its page, into run.folder. Throws InputError when one cannot be written.
void write_run(const RunReport& run);

// All that run() does with run.model once it is built; start: 3 x node_count, relative to the model's origin,
// or null for the scene's own.
void run_built(const Scene& scene, const Groundwork& ground, SolveSetup setup, const RunOptions& options,
               RunReport& run, const Points* start = nullptr);

}  // namespace coapt
