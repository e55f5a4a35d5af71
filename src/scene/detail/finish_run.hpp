// From what a solve found to its report and files. Private to this room.
#pragma once

#include "scene/groundwork.hpp"
#include "scene/run.hpp"
#include "scene/solve_scene.hpp"

namespace coapt {

// What is known of a report before the solve.
void begin_report(const Scene& scene, const SolveSetup& setup, const Model& model, const RunOptions& options,
                  Report& report);

// Solves as solve_scene() does, or from `start` as solve_again(), and keeps the shapes on the way where the
// report has a page that shows them.
CascadeOutcome solve_recorded(const Scene& scene, const Groundwork& ground, Model& model, SolveSetup setup,
                              Report& report, const Points* start = nullptr);

// Measures the shape of the outcome on run.model and writes run.report into run.folder where the options want
// files.
void finish_run(const SolveSetup& setup, CascadeOutcome outcome, const RunOptions& options, RunReport& run);

// All that run() does with run.model once it is built; start: 3 x node_count, relative to the model's origin,
// or null for the scene's own.
void run_built(const Scene& scene, const Groundwork& ground, SolveSetup setup, const RunOptions& options,
               RunReport& run, const Points* start = nullptr);

}  // namespace coapt
