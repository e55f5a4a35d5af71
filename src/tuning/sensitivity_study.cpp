#include "tuning/sensitivity_study.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "results/reference/registered_reference.hpp"
#include "results/standing.hpp"
#include "scene/build/build.hpp"
#include "scene/build/scene_geometry.hpp"
#include "scene/file/scene_parameter.hpp"
#include "sensitivity/parameters/line_lengths.hpp"
#include "sensitivity/tracked_equilibrium.hpp"
#include "solve/solve_scene.hpp"
#include "tuning/detail/scene_derivatives.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kDerivativeShare = 1e-4;  // of a number: its forces differ from linear by the square
// Greatest displacement, over the extent of the surface, with which surfaces are compared along a derivative:
// distances are then linear in it, and far above their rounding.
constexpr double kShownDisplacement = 1e-6;

// The parameters, with the scenes that differ in them.
struct Variation {
  SceneParameter parameter;
  Scene smaller, larger;
};

// Both scenes are built once, for the defects that show only there. Throws InputError.
Variation variation(const Scene& scene, const SceneGeometry& geometry, const SceneParameter& parameter,
                    double perturbation) {
  Variation varied{parameter, scaled(scene, parameter, 1 - perturbation),
                   scaled(scene, parameter, 1 + perturbation)};
  build(varied.smaller, geometry);
  build(varied.larger, geometry);
  return varied;
}

// All defects together. Parameters that nobody named and that cannot be varied go to `left_out`.
std::vector<Variation> variations(const Scene& scene, const SceneGeometry& geometry,
                                  const Objective& objective, const SensitivityOptions& options, double share,
                                  std::vector<std::string>& left_out) {
  const bool is_share = share > 0 && share < 1;
  std::vector<Variation> all;
  std::vector<std::string> defects;
  if (!is_share) defects.emplace_back("--perturb: must be a share above 0 and below 1, such as 5%");
  const auto add = [&](const auto& find, std::vector<std::string>& reasons) {
    try {
      const SceneParameter parameter = find();
      if (is_share) all.push_back(variation(scene, geometry, parameter, share));
    } catch (const InputError& error) {
      reasons.insert(reasons.end(), error.defects().begin(), error.defects().end());
    }
  };
  if (options.parameters.empty())
    for (const SceneParameter& parameter : elastic_parameters(scene, objective))
      add([&] { return parameter; }, left_out);
  for (const std::string& name : options.parameters)
    add([&] { return find_parameter(scene, name); }, defects);
  if (!defects.empty()) throw InputError(defects);
  if (!all.empty()) return all;
  if (!left_out.empty()) throw InputError(left_out);
  throw InputError(scene.file.string() + ": terms: none is elastic, there is nothing to vary");
}

// A factor on the number. Lengths of lines have exact derivatives: a central difference would strain those
// that are just slack, whose junctions nothing else holds.
std::unique_ptr<Parameter> factor_on(const Variation& varied, const SceneGeometry& geometry,
                                     const Objective& objective) {
  const std::string& name = varied.parameter.name;
  for (const auto& term : objective.terms()) {
    if (name != term->name() + ".length_scale") continue;
    const std::unique_ptr<LineAccess> lines = line_access(*term);
    bool has_lengths = lines != nullptr;
    for (int e = 0; has_lengths && e < term->stencils().count(); ++e) has_lengths = lines->rest_length(e) > 0;
    if (has_lengths) return make_line_lengths(name, *term, all_lines(*term), LengthMeasure::Factor);
  }
  return std::make_unique<SceneDerivatives>(
      name, geometry, SceneDerivatives::Neighbours{varied.smaller, varied.larger}, kDerivativeShare);
}

// The first solution, and what is compared with it.
class Study {
 public:
  Study(const SceneGeometry& geometry, const SolveSetup& setup, Model model)
      : geometry_(geometry), setup_(setup), model_(std::move(model)) {}

  SensitivityRun solve_first(const Scene& scene, const IntersectionChecker& checker) {
    const double start = wall_seconds();
    Result result = solve_scene(scene, geometry_, model_, setup_).result;
    q_ = result.q;
    x_ = model_.objective->positions(q_);
    surface_ = surface_at(model_, x_);
    SensitivityRun run = measured(1, result, model_, surface_);
    run.wall_s = wall_seconds() - start;
    const Fields fields = compute_fields(model_, x_);
    doubts_ = doubts(model_, result, fields, measure(model_, q_, fields, checker));
    return run;
  }

  // Of the first solution.
  const std::vector<std::string>& doubts_of_first() const { return doubts_; }

  SensitivityRun solve(const Scene& scene, double factor, bool starts_anew) const {
    const double start = wall_seconds();
    Model model = build(scene, geometry_);
    const Result result =
        starts_anew ? solve_scene(scene, geometry_, model, setup_).result : solve_again(x_, model, setup_);
    const TriangleMesh surface = surface_at(model, model.objective->positions(result.q));
    SensitivityRun run = measured(factor, result, model, surface);
    run.to_base = distance_between(surface, surface_);
    run.wall_s = wall_seconds() - start;
    return run;
  }

  // Makes ready for derivatives at the first solution. Throws InputError where there are none.
  void track(const std::vector<Variation>& varied) {
    TrackingOptions tracking;
    tracking.factorisation = setup_.stability.factorisation;
    tracking.tolerance = setup_.stop.tolerance;
    tracking.max_seconds = setup_.stop.max_seconds;
    tracking.observer = setup_.observer;
    equilibrium_ = std::make_unique<TrackedEquilibrium>(*model_.objective, q_, std::move(tracking));
    for (const Variation& each : varied) equilibrium_->add(factor_on(each, geometry_, *model_.objective));
    if (const WarmSolve solved = equilibrium_->solve(); solved.status != Status::Converged)
      throw InputError("the first solution is no equilibrium any more: " + solved.message);
  }

  // From the derivative of the shape by the factor of one parameter. Pre: track() has not thrown.
  void derive(Eigen::Index which, ParameterSensitivity& found) {
    const Points motion = equilibrium_->response(Vector::Unit(equilibrium_->number_count(), which));
    const Points x = equilibrium_->positions();
    const double greatest = std::sqrt(motion.colwise().squaredNorm().maxCoeff());
    if (!(greatest > 0)) {
      found.movement = 0;
      if (model_.closed_reference) found.error_change = 0;
      return;
    }
    const double change = kShownDisplacement * model_.objective->extent(equilibrium_->unknowns()) / greatest;
    const TriangleMesh here = surface_at(model_, x), smaller = surface_at(model_, x - change * motion),
                       larger = surface_at(model_, x + change * motion);
    found.movement =
        (distance_between(smaller, here).mean + distance_between(larger, here).mean) / (2 * change);
    const auto reference = placed_reference(model_, here);  // it stays with the first shape
    if (!reference) return;
    found.error_change =
        (distance_between(larger, *reference).mean - distance_between(smaller, *reference).mean) /
        (2 * change);
  }

  bool is_cancelled() const { return setup_.observer && !setup_.observer({}, q_); }

 private:
  static SensitivityRun measured(double factor, const Result& result, const Model& model,
                                 const TriangleMesh& surface) {
    SensitivityRun run{factor, result.status, result.residual, result.iterations};
    if (const auto reference = placed_reference(model, surface))
      run.to_reference = distance_between(surface, *reference);
    return run;
  }

  const SceneGeometry& geometry_;
  const SolveSetup& setup_;
  Model model_;
  Vector q_;  // of the first solution
  Points x_;
  TriangleMesh surface_;
  std::vector<std::string> doubts_;
  std::unique_ptr<TrackedEquilibrium> equilibrium_;
};

// Both solves; false: cancelled.
bool solve_both(const Study& study, const Variation& varied, double share, bool starts_anew,
                ParameterSensitivity& found) {
  for (const Scene* scene : {&varied.smaller, &varied.larger}) {
    const double factor = scene == &varied.smaller ? 1 - share : 1 + share;
    found.runs.push_back(study.solve(*scene, factor, starts_anew));
    if (found.runs.back().status == Status::Cancelled) return false;
  }
  if (!found.has_converged()) return true;
  const SensitivityRun &a = found.runs.front(), &b = found.runs.back();
  found.movement = (a.to_base.mean + b.to_base.mean) / (2 * share);
  if (a.to_reference) found.error_change = (b.to_reference->mean - a.to_reference->mean) / (2 * share);
  return true;
}

// The derivative, or where it is not defined both solves; false: cancelled.
bool derive_or_solve(const Scene& scene, const SceneGeometry& geometry, const Variation& varied,
                     Eigen::Index which, Study& study, ParameterSensitivity& found) {
  if (study.is_cancelled()) return false;
  if (found.message.empty()) try {
      study.derive(which, found);
      return true;
    } catch (const InputError& error) {
      found.message = error.defects().front();
    }
  try {
    return solve_both(study, variation(scene, geometry, varied.parameter, kPerturbation), kPerturbation,
                      false, found);
  } catch (const InputError& error) {  // beyond a limit: what can be said has been said
    found.message += "; " + error.defects().front();
    return true;
  }
}

ParameterSensitivity named(const SceneParameter& parameter) {
  ParameterSensitivity found;
  found.name = parameter.name;
  found.value = parameter.value;
  if (parameter.dimension != kDimensionless) found.unit = internal_unit(parameter.dimension);
  return found;
}

}  // namespace

bool ParameterSensitivity::has_converged() const {
  return std::all_of(runs.begin(), runs.end(),
                     [](const SensitivityRun& run) { return run.status == Status::Converged; }) &&
         (!runs.empty() || movement);
}

bool SensitivityStudy::has_converged() const {
  return !is_cancelled && base.status == Status::Converged && !parameters.empty() &&
         std::all_of(parameters.begin(), parameters.end(),
                     [](const ParameterSensitivity& p) { return p.has_converged(); });
}

SensitivityStudy study_sensitivity(const Scene& scene, const SolverTable& solvers,
                                   const SensitivityOptions& options, const RunOptions& run) {
  const double start = wall_seconds();
  const SolveSetup setup = solve_setup(scene, solvers, run);
  const SceneGeometry geometry = scene_geometry(scene);
  Model model = build(scene, geometry);
  if (model.mesh.triangle_count() == 0)
    throw InputError(scene.file.string() + ": mesh: missing; the study compares surfaces");
  SensitivityStudy study;
  study.scene_file = scene.file.filename().string();
  study.solver = setup.solver;
  study.tolerance = setup.stop.tolerance;
  study.perturbation = options.perturbation;
  if (options.starts_anew && !study.perturbation) study.perturbation = kPerturbation;
  study.starts_anew = options.starts_anew;
  const std::vector<Variation> varied =
      variations(scene, geometry, *model.objective, options, study.perturbation.value_or(kDerivativeShare),
                 study.left_out);

  Study solution(geometry, setup, std::move(model));
  study.base = solution.solve_first(scene, run.checker);
  study.doubts = solution.doubts_of_first();
  study.is_cancelled = study.base.status == Status::Cancelled;
  std::string message;
  if (study.base.status == Status::Converged && !study.perturbation) try {
      solution.track(varied);
    } catch (const InputError& error) {
      message = error.defects().front();
    }
  for (size_t k = 0; k < varied.size() && study.base.status == Status::Converged; ++k) {
    const double begin = wall_seconds();
    ParameterSensitivity found = named(varied[k].parameter);
    found.message = message;
    const bool is_whole =
        study.perturbation
            ? solve_both(solution, varied[k], *study.perturbation, study.starts_anew, found)
            : derive_or_solve(scene, geometry, varied[k], static_cast<Eigen::Index>(k), solution, found);
    study.is_cancelled = !is_whole;
    if (!is_whole) break;  // half a parameter says nothing
    found.wall_s = wall_seconds() - begin;
    study.parameters.push_back(found);
    if (options.report) options.report(found);
  }
  study.wall_s = wall_seconds() - start;
  return study;
}

}  // namespace coapt
