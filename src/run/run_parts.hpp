// The parts of run(), for studies that solve the same scene again and again.
#pragma once

#include "run/run.hpp"
#include "scene/build/scene_geometry.hpp"
#include "solve/solve_scene.hpp"

namespace coapt {

// --- solve, measure, write: each a value in and a value out; run_built() and complete_run() compose them
// -----

// What a solve leaves, nothing of it measured.
struct SolvedRun {
  CascadeOutcome outcome;
  std::vector<RecordedShape> shape_history;  // to the result, where it was kept
};

// Solves as solve_scene() does, or from `start` as solve_again(). keeps_history: a page will show it.
SolvedRun solve_run(const Scene& scene, const SceneGeometry& geometry, Model& model, SolveSetup setup,
                    bool keeps_history, const Points* start = nullptr);

// What a report says beside what is measured.
struct RunNotes {
  bool has_page = false, has_frames = false;
  std::optional<AccuracyEstimate> accuracy = {};
  std::vector<std::string> warnings = {};
  std::function<FirstOrder(const Report&)> first_order = {};  // asked before the page is written
};

// Whether the options and the scene want report.html.
bool wants_page(const Scene& scene, const RunOptions& options);

// Measures the shape of the outcome; writes nothing.
Report measure_run(const Scene& scene, const SolveSetup& setup, const Model& model, SolvedRun solved,
                   const RunNotes& notes, const IntersectionChecker& checker);

// The files of the result, result.json first, then its page. Throws InputError when one cannot be written.
void write_run(const std::filesystem::path& folder, const Model& model, const Report& report);

// What follows a solve: measures it and writes it into the folder; an empty one: writes nothing.
Report complete_run(const Scene& scene, const SolveSetup& setup, const Model& model, SolvedRun solved,
                    const RunNotes& notes, const IntersectionChecker& checker,
                    const std::filesystem::path& folder);

// Where the options want results, made and without the frames of an earlier solve; empty where they want
// none. Throws InputError for a folder that cannot be written.
std::filesystem::path open_result_folder(const Scene& scene, const RunOptions& options);

// solve_setup(), without a certificate where it would need Hessians that are not there. Throws InputError for
// given terms together with a cascade.
SolveSetup given_setup(const Scene& scene, const Given& given, const SolverTable& solvers,
                       const RunOptions& options);

// Of the mesh that is given, which is taken out of it, or of the scene's own.
SceneGeometry given_geometry(const Scene& scene, Given& given);

// A given start, 3 x node_count, relative to the model's origin. Throws InputError for another number of
// nodes and for coordinates that are not finite.
Points relative_start(const Eigen::Map<const Points>& start, const Model& model);

// All that run() does with a model once it is built, which is left at the end of the solve; folder: of
// open_result_folder(); start: 3 x node_count, relative to the model's origin, or null for the scene's own.
Report run_built(const Scene& scene, const SceneGeometry& geometry, SolveSetup setup,
                 const RunOptions& options, Model& model, const std::filesystem::path& folder,
                 const Points* start = nullptr);

}  // namespace coapt
