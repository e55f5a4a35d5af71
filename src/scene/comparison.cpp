#include "scene/comparison.hpp"

#include "core/error.hpp"
#include "mesh/vtp_writer.hpp"
#include "scene/build.hpp"
#include "scene/detail/method_verdict.hpp"
#include "scene/mass_spring_scene.hpp"
#include "scene/result_surfaces.hpp"
#include "scene/suggestion.hpp"
#include "scene/term_types.hpp"

#include <algorithm>
#include <system_error>

namespace coapt {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMassSpring = "mass-spring";
constexpr const char* kMassSpringSolver = "dynamic";
constexpr const char* kConstraintSolver = "xpbd";
constexpr const char* kRefiningSolver = "newton";
constexpr double kRefinement = 1e-3;       // of the tolerance, to tell two branches from a loose tolerance
constexpr double kLeastTolerance = 1e-10;  // that refining asks for

MethodModel model_of(const std::string& method, const Scene& scene) {
  if (method == kMassSpring) return has_springs_alone(scene) ? MethodModel::Scene : MethodModel::Springs;
  return method == kConstraintSolver ? MethodModel::Constraints : MethodModel::Scene;
}

// Defects of the list of methods, each method once.
void check_methods(const std::vector<std::string>& methods, const std::vector<std::string>& known,
                   std::vector<std::string>& defects) {
  if (methods.empty()) defects.push_back("--methods: none is named; there are: " + listed(known));
  for (size_t k = 0; k < methods.size(); ++k) {
    if (std::find(known.begin(), known.end(), methods[k]) == known.end())
      defects.push_back("--methods: \"" + methods[k] + "\" is not known" + suggestion(methods[k], known) +
                        "; this build has: " + listed(known));
    const auto here = methods.begin() + static_cast<std::ptrdiff_t>(k);
    if (std::find(methods.begin(), here, methods[k]) != here)
      defects.push_back("--methods: \"" + methods[k] + "\" is named twice");
  }
}

void check_closed(const Scene& scene, const fs::path& closed, std::vector<std::string>& defects) {
  std::error_code error;
  if (closed.empty()) return;
  if (!fs::is_regular_file(closed, error))
    defects.push_back("--closed: file " + closed.string() + " not found; give a surface (.obj, .ply, ...)");
  if (!scene.mesh)
    defects.push_back("--closed: " + scene.file.string() + " has no mesh that could be compared with it");
}

// The methods in the order in which they are solved. Throws InputError.
std::vector<std::string> reference_first(const Scene& scene, const SolverTable& solvers,
                                         const ComparisonOptions& options) {
  std::vector<std::string> methods = options.methods, defects;
  check_methods(methods, known_methods(solvers), defects);
  const std::string wanted = options.reference.empty() ? kRefiningSolver : options.reference;
  const auto reference = std::find(methods.begin(), methods.end(), wanted);
  if (reference == methods.end() && !options.reference.empty())
    defects.push_back("--reference: \"" + wanted + "\" is not among the methods: " + listed(methods));
  check_closed(scene, options.closed, defects);
  if (!defects.empty()) throw InputError(defects);
  if (reference != methods.end()) std::rotate(methods.begin(), reference, reference + 1);
  return methods;
}

Scene with_closed_surface(Scene scene, const fs::path& closed) {
  if (closed.empty()) return scene;
  scene.closed_surface = closed;
  scene.closed_surface_scale = scene.mesh->scale;
  return scene;
}

double extent_of(const Model& model) {
  return bounding_box_diagonal(model.mesh.triangle_count() > 0 ? model.mesh.vertices : model.X);
}

// Solves, measures and writes as `run` does for any scene.
RunReport run_method(const Scene& scene, const std::string& method, const SolverTable& solvers,
                     RunOptions options) {
  options.solver = method == kMassSpring ? kMassSpringSolver : method;
  options.folder /= method;
  std::error_code ignored;
  // Where this one fails, that of an earlier comparison would be taken for its own.
  if (options.writes) fs::remove(options.folder / "result.json", ignored);
  return run(method == kMassSpring ? mass_spring_scene(scene) : scene, solvers, options);
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

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : "; ") + text;
  return all;
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

std::vector<std::string> known_methods(const SolverTable& solvers) {
  std::vector<std::string> known;
  for (const auto& [name, factory] : solvers) known.push_back(name);
  if (solvers.contains(kMassSpringSolver) && find_term_type("spring") != nullptr)
    known.emplace_back(kMassSpring);
  return known;
}

Comparison compare_methods(const Scene& given, const SolverTable& solvers, const ComparisonOptions& options,
                           const RunOptions& wanted) {
  const std::vector<std::string> names = reference_first(given, solvers, options);
  const Scene scene = with_closed_surface(given, options.closed);
  RunOptions run = wanted;
  if (run.folder.empty()) run.folder = result_folder(scene);
  const std::optional<SolveSetup> refining = refining_setup(scene, solvers, run);

  Comparison found;
  found.scene_file = scene.file.filename().string();
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
      method.run = run_method(scene, name, solvers, run);
      if (&method != &reference && reference.run) measure_gap(reference, method);
      if (method.gap && run.writes)
        write_vtp(method.run->folder / "closed.vtp",
                  closed_surface(method.run->model, method.run->report.fields));
      judge_method(reference, method, kSameShape * found.extent_mm, refining);
    } catch (const InputError& error) {
      method.message = joined(error.defects());
    } catch (const std::exception& error) {
      method.message = error.what();
    }
    if (options.report) options.report(method);
    found.is_cancelled = method.run && method.run->report.result.status == Status::Cancelled;
    if (found.is_cancelled) break;
  }
  return found;
}

}  // namespace coapt
