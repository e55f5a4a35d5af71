#include "scene/run.hpp"

#include "core/error.hpp"
#include "optim/smallest_modes.hpp"
#include "scene/build.hpp"
#include "scene/groundwork.hpp"
#include "scene/suggestion.hpp"

#include <cmath>
#include <iterator>

namespace coapt {
namespace {

FactorisationFactory chosen_factorisation(const FactorisationTable& table, const std::string& name) {
  if (name == "auto") return table.contains("cholmod") ? table.at("cholmod") : make_eigen_factorisation;
  if (const auto found = table.find(name); found != table.end()) return found->second;
  throw InputError("factorisation \"" + name + "\" is not in this build; use \"auto\" or \"eigen\"");
}

std::unique_ptr<Solver> make_solver(const SolverTable& solvers, const std::string& name,
                                    const SolverOptions& options) {
  const auto found = solvers.find(name);
  if (found == solvers.end()) {
    std::vector<std::string> known;
    for (const auto& [key, factory] : solvers) known.push_back(key);
    throw InputError("solver \"" + name + "\" is not known" + suggestion(name, known) +
                     "; this build has: " + listed(known));
  }
  return found->second(options);
}

StopRule stop_rule(const Scene& scene, const RunOptions& options) {
  StopRule stop;
  stop.tolerance = options.tolerance.value_or(scene.solver.tolerance);
  stop.max_iterations = scene.solver.max_iterations;
  const double seconds = options.max_seconds.value_or(scene.solver.max_seconds);
  stop.max_seconds = seconds > 0 ? seconds : kInfinity;
  if (!(stop.tolerance > 0 && stop.tolerance <= 1))
    throw InputError("--tolerance: must be above 0 and at most 1, a residual relative to the largest force");
  if (std::isnan(seconds)) throw InputError("--max-seconds: must be a number of seconds");
  return stop;
}

}  // namespace

std::filesystem::path result_folder(const Scene& scene) {
  return scene.output_folder ? *scene.output_folder : scene.file.parent_path() / "result";
}

RunReport run(const Scene& scene, const SolverTable& solvers, const RunOptions& options) {
  RunReport run;
  Report& report = run.report;
  report.solver = options.solver.empty() ? scene.solver.type : options.solver;
  const FactorisationFactory factorisation =
      chosen_factorisation(options.factorisations, scene.solver.factorisation);
  const SolverOptions solver_options{scene.solver.memory, scene.solver.is_preconditioned,
                                     scene.solver.globalisation, factorisation};
  const StabilityOptions stability{factorisation, options.modes.value_or(scene.solver.modes)};
  const SolverMaker maker = [&] { return make_solver(solvers, report.solver, solver_options); };
  const std::unique_ptr<Solver> solver = maker();
  const StopRule stop = stop_rule(scene, options);
  const Groundwork ground = lay_groundwork(scene);
  run.model = build(scene, ground);
  Model& model = run.model;
  // Only now: a scene that is refused leaves no folder behind.
  if (options.writes) {
    run.folder = options.folder.empty() ? result_folder(scene) : options.folder;
    prepare_result_folder(run.folder);
  }
  report.scene_file = scene.file.filename().string();
  report.tolerance = stop.tolerance;
  report.warnings = model.warnings;
  if (scene.solver.cascade) {
    CascadeOutcome outcome = solve_cascade(scene, ground, model, maker, stop, options.observer, stability);
    report.result = std::move(outcome.result);
    report.levels = std::move(outcome.levels);
    report.warnings.insert(report.warnings.end(), outcome.warnings.begin(), outcome.warnings.end());
  } else {
    report.result =
        solve(*solver, {*model.objective, model.q0, model.motion, scene.solver.continuation, stability}, stop,
              options.observer);
  }

  const Result& result = report.result;
  report.pressure_route = pressure_route(model, result);
  report.fields = compute_fields(model, model.objective->positions(result.q));
  report.metrics = measure(model, result.q, report.fields, options.judge);
  report.reference = compare_with_reference(model, report.fields);
  if (stability.modes > 0 && !has_smallest_modes())
    report.warnings.push_back("The smallest eigenvalues need a build with Spectra; this one has none.");
  const long slack = report.metrics.slack_chords.value_or(0), lines = std::ssize(model.lines);
  if (2 * slack > lines)
    report.warnings.push_back(std::to_string(slack) + " of " + std::to_string(lines) +
                              " chords and cables are slack in the result: are their rest lengths right?");
  if (report.metrics.intersections > 0)
    report.warnings.push_back(std::to_string(report.metrics.intersections) +
                              " pairs of facets pass through each other in the result.");
  if (options.writes) write_results(run.folder, model, report);
  return run;
}

}  // namespace coapt
