#include "run/run.hpp"

#include "core/error.hpp"
#include "formats/whole_file.hpp"
#include "optim/dynamic/dynamic.hpp"
#include "optim/stability/smallest_modes.hpp"
#include "report/shape_view.hpp"
#include "report/solve_page.hpp"
#include "results/frames.hpp"
#include "results/result_warnings.hpp"
#include "results/write_attempts.hpp"
#include "run/replaced_inputs.hpp"
#include "run/run_parts.hpp"
#include "run/unwritten.hpp"
#include "scene/build/build.hpp"
#include "scene/build/scene_geometry.hpp"
#include "solve/solve_scene.hpp"

#include <algorithm>
#include <iterator>

namespace coapt {

namespace {

// Where links lead; an empty path, as the folder of a bare name, is the working directory.
std::filesystem::path real_path(const std::filesystem::path& path) {
  return std::filesystem::weakly_canonical(std::filesystem::absolute(path.empty() ? "." : path));
}

// Whether `path` is the folder or lies in it.
bool lies_in(const std::filesystem::path& path, const std::filesystem::path& folder) {
  const auto inner = real_path(path), outer = real_path(folder);
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

}  // namespace

std::filesystem::path result_folder(const Scene& scene) {
  const std::filesystem::path own = scene.file.parent_path();
  if (!scene.output_folder) return own / "result";
  // A scene may come from anywhere: it does not choose among all the files of whoever solves it.
  if (!lies_in(*scene.output_folder, own) && !lies_in(*scene.output_folder, std::filesystem::current_path()))
    throw InputError(
        scene.file.string() + ": output.folder: " + scene.output_folder->string() +
        " lies outside the folder of the scene and the working directory; give a folder with -o");
  return *scene.output_folder;
}

bool wants_page(const Scene& scene, const RunOptions& options) {
  return options.writes && options.writes_page.value_or(scene.writes_page);
}

SolvedRun solve_run(const Scene& scene, const SceneGeometry& geometry, Model& model, SolveSetup setup,
                    bool keeps_history, const Points* start) {
  std::optional<ShapeRecord> record;
  if (keeps_history && has_shape_view()) {
    record.emplace(model, page_shapes(model));
    setup.observer = [&record, next = setup.observer](const Iteration& iteration, const Vector& q) {
      record->see(iteration, q);
      return !next || next(iteration, q);
    };
  }
  SolvedRun solved;
  if (start == nullptr)
    solved.outcome = solve_scene(scene, geometry, model, setup);
  else
    solved.outcome.result = solve_again(*start, model, setup);
  if (record) solved.shape_history = record->shapes(model.objective->positions(solved.outcome.result.q));
  return solved;
}

Report measure_run(const Scene& scene, const SolveSetup& setup, const Model& model, SolvedRun solved,
                   const RunNotes& notes, const IntersectionChecker& checker) {
  Report report;
  report.scene_file = scene.file.filename().string();
  report.scene_title = scene_title(scene);
  report.solver = setup.solver;
  report.tolerance = setup.stop.tolerance;
  report.has_collisions = is_dynamic(setup.solver) && scene.solver.dynamic.collisions != Collisions::None;
  report.has_page = notes.has_page;
  report.has_frames = notes.has_frames;
  report.accuracy = notes.accuracy;
  report.shape_history = std::move(solved.shape_history);
  report.result = std::move(solved.outcome.result);
  report.levels = std::move(solved.outcome.levels);
  for (const auto* warnings : {&model.warnings, &notes.warnings, &std::as_const(solved.outcome.warnings)})
    report.warnings.insert(report.warnings.end(), warnings->begin(), warnings->end());

  const Result& result = report.result;
  report.pressure_route = pressure_route(model, result);
  report.fields = compute_fields(model, model.objective->positions(result.q));
  if (!result.certificate.free_nodes.empty())
    report.fields.undetermined =
        undetermined_flags(result.certificate.free_nodes, std::nullopt, model.objective->node_count());
  report.metrics = measure(model, result.q, report.fields, checker);
  report.reference =
      compare_with_reference(model, report.fields, result.certificate.free_nodes, report.metrics.closure);
  if (report.reference)
    report.warnings.insert(report.warnings.end(), report.reference->doubts.begin(),
                           report.reference->doubts.end());
  if (setup.stability.modes > 0 && !has_smallest_modes())
    report.warnings.push_back("The smallest eigenvalues need a build with Spectra; this one has none.");
  const long slack = report.metrics.slack_chords.value_or(0), lines = std::ssize(model.lines);
  if (2 * slack > lines)
    report.warnings.push_back(std::to_string(slack) + " of " + std::to_string(lines) +
                              " chords and cables are slack in the result: are their rest lengths right?");
  if (report.metrics.intersections > 0)
    report.warnings.push_back(std::to_string(report.metrics.intersections) +
                              " pairs of facets pass through each other in the result.");
  for (const std::string& warning : {stretch_warning(report.fields), yield_warning(report.fields)})
    if (!warning.empty()) report.warnings.push_back(warning);
  report.surface_doubts = surface_doubts(model.mesh);
  withdraw_penetrated(report);
  report.neighbours = check_neighbours(report.solver, result, report.levels);
  if (const std::string warning = neighbour_warning(report.neighbours); !warning.empty())
    report.warnings.insert(report.warnings.begin(), warning);
  return report;
}

namespace {

// complete: what the report gets for its page, once all else is written; empty: nothing. The page is written
// before as well, so that no earlier one stands beside the new result for as long as that takes.
void write_files(const std::filesystem::path& folder, const Model& model, const Report& report,
                 const std::function<void()>& complete) {
  const std::filesystem::path page = folder / "report.html";
  std::error_code ignored;
  try {
    WriteAttempts attempt;
    attempt([&] { write_results(folder, model, report); });
    if (report.has_page) {
      bool is_written = false;
      attempt([&] {
        formats::write_whole(page, solve_page(model, report));
        is_written = true;
      });
      if (complete && is_written) {
        complete();
        attempt([&] { formats::write_whole(page, solve_page(model, report)); });
      }
    } else {
      std::filesystem::remove(page, ignored);  // of an earlier solve
    }
    attempt.finish();
  } catch (const OutputError& error) {
    throw UnwrittenReport(error, report);
  }
}

}  // namespace

void write_run(const std::filesystem::path& folder, const Model& model, const Report& report) {
  write_files(folder, model, report, {});
}

std::filesystem::path open_result_folder(const Scene& scene, const RunOptions& options) {
  if (!options.writes) return {};
  std::filesystem::path folder = options.folder.empty() ? result_folder(scene) : options.folder;
  refuse_replaced_inputs(scene, folder, solve_files());
  prepare_result_folder(folder);
  remove_frames(folder);
  return folder;
}

Report complete_run(const Scene& scene, const SolveSetup& setup, const Model& model, SolvedRun solved,
                    const RunNotes& notes, const IntersectionChecker& checker,
                    const std::filesystem::path& folder) {
  Report report = measure_run(scene, setup, model, std::move(solved), notes, checker);
  if (folder.empty()) return report;
  std::function<void()> complete;
  if (notes.first_order && has_shape_view()) {
    report.first_order = FirstOrder{.message = "they were still being made when this page was written"};
    complete = [&] { report.first_order = notes.first_order(report); };
  }
  write_files(folder, model, report, complete);
  return report;
}

Report run_built(const Scene& scene, const SceneGeometry& geometry, SolveSetup setup,
                 const RunOptions& options, Model& model, const std::filesystem::path& folder,
                 const Points* start) {
  std::optional<FrameWriter> frames;
  const int interval = options.frame_interval.value_or(scene.frame_interval);
  if (!folder.empty() && interval > 0) {
    frames.emplace(folder, interval, model);
    setup.observer = [&frames, next = setup.observer](const Iteration& iteration, const Vector& q) {
      frames->see(iteration, q);
      return !next || next(iteration, q);
    };
  }
  const bool has_page = wants_page(scene, options);
  SolvedRun solved = solve_run(scene, geometry, model, setup, has_page, start);
  std::optional<OutputError> lost_frames;
  if (frames) try {
      frames->finish();
    } catch (const OutputError& error) {
      lost_frames = error;
    }
  const auto complete = [&] {
    RunNotes notes{.has_page = has_page, .has_frames = frames && !lost_frames};
    if (options.first_order)
      notes.first_order = [&](const Report& report) { return options.first_order(scene, model, report); };
    return complete_run(scene, setup, model, std::move(solved), notes, options.checker, folder);
  };
  if (!lost_frames) return complete();
  try {
    throw UnwrittenReport(*lost_frames, complete());
  } catch (const UnwrittenReport& error) {  // of the frames, or of the files that come after them
    std::vector<std::string> defects = lost_frames->defects();
    if (error.defects() != defects)
      defects.insert(defects.end(), error.defects().begin(), error.defects().end());
    throw UnwrittenReport(OutputError(defects), std::move(error.report()));
  }
}

RunReport run(const Scene& scene, const SolverTable& solvers, const RunOptions& options) {
  RunReport run;
  SolveSetup setup = solve_setup(scene, solvers, options);
  const SceneGeometry geometry = scene_geometry(scene);
  run.model = build(scene, geometry);
  if (options.doubts)
    for (std::string& doubt : options.doubts(scene, geometry, run.model))
      if (std::find(run.model.warnings.begin(), run.model.warnings.end(), doubt) == run.model.warnings.end())
        run.model.warnings.push_back(std::move(doubt));
  run.folder = open_result_folder(scene, options);  // only now: a scene that is refused leaves none behind
  try {
    run.report = run_built(scene, geometry, std::move(setup), options, run.model, run.folder);
  } catch (const UnwrittenReport& error) {
    run.report = std::move(error.report());
    throw UnwrittenRun(error, std::move(run));
  }
  return run;
}

}  // namespace coapt
