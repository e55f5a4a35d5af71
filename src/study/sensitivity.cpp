#include "study/sensitivity.hpp"

#include "core/error.hpp"
#include "scene/build/build.hpp"
#include "scene/build/groundwork.hpp"
#include "scene/file/scene_parameter.hpp"
#include "solve/solve_scene.hpp"

#include <algorithm>
#include <array>

namespace coapt {
namespace {

// The parameters, with the scenes that differ in them.
struct Variation {
  SceneParameter parameter;
  Scene smaller, larger;
};

// Both scenes are built once, for the defects that show only there. Throws InputError.
Variation variation(const Scene& scene, const Groundwork& ground, const SceneParameter& parameter,
                    double perturbation) {
  Variation varied{parameter, scaled(scene, parameter, 1 - perturbation),
                   scaled(scene, parameter, 1 + perturbation)};
  build(varied.smaller, ground);
  build(varied.larger, ground);
  return varied;
}

// All defects in one pass. Parameters that nobody named and that cannot be varied go to `left_out`.
std::vector<Variation> variations(const Scene& scene, const Groundwork& ground, const Objective& objective,
                                  const SensitivityOptions& options, std::vector<std::string>& left_out) {
  const bool is_share = options.perturbation > 0 && options.perturbation < 1;
  std::vector<Variation> all;
  std::vector<std::string> defects;
  if (!is_share) defects.emplace_back("--perturb: must be a share above 0 and below 1, such as 5%");
  const auto add = [&](const auto& find, std::vector<std::string>& reasons) {
    try {
      const SceneParameter parameter = find();
      if (is_share) all.push_back(variation(scene, ground, parameter, options.perturbation));
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

class Study {
 public:
  Study(const Groundwork& ground, const SolveSetup& setup, bool starts_anew)
      : ground_(ground), setup_(setup), starts_anew_(starts_anew) {}

  SensitivityRun solve(const Scene& scene, double factor) {
    Model model = build(scene, ground_);
    const double start = wall_seconds();
    const Result result = is_first() || starts_anew_ ? solve_scene(scene, ground_, model, setup_).result
                                                     : solve_again(base_x_, model, setup_);
    SensitivityRun run{factor, result.status, result.residual, result.iterations, wall_seconds() - start};
    const Points x = model.objective->positions(result.q);
    const TriangleMesh surface = surface_at(model, x);
    if (is_first()) {
      base_x_ = x;
      base_ = surface;
    } else {
      run.to_base = distance_between(surface, base_);
    }
    if (model.closed_reference) run.to_reference = distance_between(surface, *model.closed_reference);
    return run;
  }

 private:
  bool is_first() const { return base_x_.size() == 0; }

  const Groundwork& ground_;
  const SolveSetup& setup_;
  bool starts_anew_;
  Points base_x_ = Points(3, 0);
  TriangleMesh base_;
};

void judge(ParameterSensitivity& found, double perturbation) {
  const SensitivityRun &a = found.smaller, &b = found.larger;
  if (a.status != Status::Converged || b.status != Status::Converged) return;
  found.movement = (a.to_base.mean + b.to_base.mean) / (2 * perturbation);
  if (a.to_reference) found.error_change = (b.to_reference->mean - a.to_reference->mean) / (2 * perturbation);
}

}  // namespace

bool SensitivityStudy::has_converged() const {
  return !is_cancelled && base.status == Status::Converged && !parameters.empty() &&
         std::all_of(parameters.begin(), parameters.end(), [](const ParameterSensitivity& p) {
           return p.smaller.status == Status::Converged && p.larger.status == Status::Converged;
         });
}

SensitivityStudy study_sensitivity(const Scene& scene, const SolverTable& solvers,
                                   const SensitivityOptions& options, const RunOptions& run) {
  const double start = wall_seconds();
  const SolveSetup setup = solve_setup(scene, solvers, run);
  const Groundwork ground = lay_groundwork(scene);
  const Model model = build(scene, ground);
  if (model.mesh.triangle_count() == 0)
    throw InputError(scene.file.string() + ": mesh: missing; the study compares surfaces");
  SensitivityStudy study;
  const std::vector<Variation> varied = variations(scene, ground, *model.objective, options, study.left_out);
  study.scene_file = scene.file.filename().string();
  study.solver = setup.solver;
  study.tolerance = setup.stop.tolerance;
  study.perturbation = options.perturbation;
  study.starts_anew = options.starts_anew;
  Study solves(ground, setup, options.starts_anew);
  study.base = solves.solve(scene, 1);
  study.is_cancelled = study.base.status == Status::Cancelled;
  if (study.base.status == Status::Converged) {
    for (const Variation& variation : varied) {
      ParameterSensitivity found;
      found.name = variation.parameter.name;
      found.value = variation.parameter.value;
      if (variation.parameter.dimension != kDimensionless)
        found.unit = internal_unit(variation.parameter.dimension);
      found.smaller = solves.solve(variation.smaller, 1 - options.perturbation);
      if (found.smaller.status != Status::Cancelled)
        found.larger = solves.solve(variation.larger, 1 + options.perturbation);
      study.is_cancelled =
          found.smaller.status == Status::Cancelled || found.larger.status == Status::Cancelled;
      if (study.is_cancelled) break;  // half a parameter says nothing
      judge(found, options.perturbation);
      study.parameters.push_back(found);
      if (options.report) options.report(found);
    }
  }
  study.wall_s = wall_seconds() - start;
  return study;
}

}  // namespace coapt
