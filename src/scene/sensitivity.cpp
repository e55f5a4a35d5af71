#include "scene/sensitivity.hpp"

#include "core/error.hpp"
#include "scene/build.hpp"
#include "scene/groundwork.hpp"
#include "scene/scene_parameter.hpp"
#include "scene/solve_scene.hpp"

#include <algorithm>
#include <array>

namespace coapt {
namespace {

// The parameters, with the scenes that differ in them. All defects in one pass.
struct Variation {
  SceneParameter parameter;
  Scene smaller, larger;
};

std::vector<Variation> variations(const Scene& scene, const Objective& objective,
                                  const SensitivityOptions& options) {
  std::vector<Variation> all;
  std::vector<std::string> defects;
  const auto add = [&](const auto& find) {
    try {
      const SceneParameter parameter = find();
      all.push_back({parameter, scaled(scene, parameter, 1 - options.perturbation),
                     scaled(scene, parameter, 1 + options.perturbation)});
    } catch (const InputError& error) {
      defects.insert(defects.end(), error.defects().begin(), error.defects().end());
    }
  };
  if (options.parameters.empty())
    for (const SceneParameter& parameter : elastic_parameters(scene, objective))
      add([&] { return parameter; });
  for (const std::string& name : options.parameters) add([&] { return find_parameter(scene, name); });
  if (!(options.perturbation > 0 && options.perturbation < 1))
    defects.insert(defects.begin(), "--perturb: must be a share above 0 and below 1, such as 5%");
  if (!defects.empty()) throw InputError(defects);
  if (all.empty())
    throw InputError(scene.file.string() + ": terms: none is elastic, there is nothing to vary");
  return all;
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
  return base.status == Status::Converged && !parameters.empty() &&
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
  const std::vector<Variation> varied = variations(scene, *model.objective, options);

  SensitivityStudy study{scene.file.filename().string(),
                         setup.solver,
                         setup.stop.tolerance,
                         options.perturbation,
                         options.starts_anew,
                         {},
                         {},
                         0};
  Study solves(ground, setup, options.starts_anew);
  study.base = solves.solve(scene, 1);
  if (study.base.status == Status::Converged) {
    for (const Variation& variation : varied) {
      ParameterSensitivity found;
      found.name = variation.parameter.name;
      found.value = variation.parameter.value;
      if (variation.parameter.dimension != kDimensionless)
        found.unit = internal_unit(variation.parameter.dimension);
      found.smaller = solves.solve(variation.smaller, 1 - options.perturbation);
      if (found.smaller.status == Status::Cancelled) break;
      found.larger = solves.solve(variation.larger, 1 + options.perturbation);
      if (found.larger.status == Status::Cancelled) break;
      judge(found, options.perturbation);
      study.parameters.push_back(found);
      if (options.report) options.report(found);
    }
  }
  study.wall_s = wall_seconds() - start;
  return study;
}

}  // namespace coapt
