#include "study/comparison.hpp"

#include "core/error.hpp"
#include "formats/vtk/vtp_writer.hpp"
#include "results/result_surfaces.hpp"
#include "scene/build/build.hpp"
#include "study/detail/method_list.hpp"
#include "study/detail/method_verdict.hpp"

#include <algorithm>
#include <system_error>

namespace coapt {
namespace {

namespace fs = std::filesystem;

constexpr double kRefinement = 1e-3;       // of the tolerance, to tell two branches from a loose tolerance
constexpr double kLeastTolerance = 1e-10;  // that refining asks for

double extent_of(const Model& model) {
  return bounding_box_diagonal(model.mesh.triangle_count() > 0 ? model.mesh.vertices : model.X);
}

// Solves, measures and writes as `run` does for any scene.
RunReport run_method(const Scene& scene, const std::string& method, const SolverTable& solvers,
                     RunOptions options, const BranchSearch& branches) {
  options.solver = method;
  options.folder /= method;
  std::error_code ignored;
  // Where this one fails, that of an earlier comparison would be taken for its own.
  if (options.writes) fs::remove(options.folder / "result.json", ignored);
  const Scene own = scene_of(method, scene);
  RunReport report = run(own, solvers, options);
  if (report.report.result.status == Status::Converged)
    report.report =
        with_branches(own, solvers, options, branches, report.model, std::move(report.report), report.folder);
  return report;
}

// How newton goes on from two shapes that a loose tolerance may have kept apart.
std::optional<SolveSetup> refining_setup(const Scene& scene, const SolverTable& solvers, RunOptions options) {
  if (!solvers.contains(kRefiningSolver)) return std::nullopt;
  const double tolerance = options.tolerance.value_or(scene.solver.tolerance);
  options.solver = kRefiningSolver;
  options.tolerance = std::min(tolerance, std::max(kRefinement * tolerance, kLeastTolerance));
  options.modes = 0;
  return solve_setup(scene, solvers, options);
}

}  // namespace

std::string_view method_model_name(MethodModel model) {
  switch (model) {
    case MethodModel::Scene:
      return "scene";
    case MethodModel::Springs:
      return "springs";
    case MethodModel::Constraints:
      return "constraints";
  }
  return "";
}

std::string_view verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::Reference:
      return "reference";
    case Verdict::SameEquilibrium:
      return "same equilibrium";
    case Verdict::AnotherBranch:
      return "another branch";
    case Verdict::NotConverged:
      return "not converged";
    case Verdict::ModelGap:
      return "model gap";
    case Verdict::NoReference:
      return "no reference";
    case Verdict::Failed:
      return "failed";
  }
  return "";
}

bool Comparison::has_converged() const {
  return !is_cancelled && std::all_of(methods.begin(), methods.end(), [](const ComparedMethod& method) {
    return method.run && method.verdict != Verdict::Failed &&
           method.run->report.result.status == Status::Converged;
  });
}

Comparison compare_methods(const Scene& given, const SolverTable& solvers, const ComparisonOptions& options,
                           const RunOptions& wanted) {
  std::vector<std::string> defects;
  check_methods(given, solvers, {options.methods, options.reference, options.closed}, defects);
  if (!defects.empty()) throw InputError(defects);
  const std::vector<std::string> names = reference_first(options.methods, options.reference);
  const Scene scene = with_closed_surface(given, options.closed);
  RunOptions run = wanted;
  if (run.folder.empty()) run.folder = result_folder(scene);
  const std::optional<SolveSetup> refining = refining_setup(scene, solvers, run);

  Comparison found;
  found.scene_file = scene.file.filename().string();
  found.scene_title = scene_title(scene);
  found.tolerance = run.tolerance.value_or(scene.solver.tolerance);
  if (scene.closed_surface) found.closed_surface = scene.closed_surface->filename().string();
  found.extent_mm = extent_of(build(scene));  // what no method could be asked for is said before the first
  if (run.writes) {
    prepare_result_folder(run.folder);
    found.folder = run.folder;
  }
  found.methods.reserve(names.size());  // so that the reference stays where it is
  for (const std::string& name : names) {
    found.methods.push_back({.name = name, .model = model_of(name, scene)});
    ComparedMethod &method = found.methods.back(), &reference = found.methods.front();
    try {
      method.run = run_method(scene, name, solvers, run, options.branches);
      if (&method != &reference && reference.run) measure_gap(reference, method);
      if (method.gap && run.writes)
        write_vtp(method.run->folder / "closed.vtp",
                  closed_surface(method.run->model, method.run->report.fields));
      judge_method(reference, method, kSameShape * found.extent_mm, refining);
      if (method.run && method.run->report.branches)
        method.message += "; other equilibria: " + branches_message(*method.run->report.branches);
    } catch (const InputError& error) {
      method.message = in_one_line(error);
    } catch (const std::exception& error) {
      method.message = error.what();
    }
    method.shares = shared_with_newton(method, scene);
    if (options.report) options.report(method);
    found.is_cancelled = method.run && method.run->report.result.status == Status::Cancelled;
    if (found.is_cancelled) break;
  }
  return found;
}

}  // namespace coapt
