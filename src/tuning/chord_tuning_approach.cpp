#include "tuning/chord_tuning_approach.hpp"

#include "core/timing.hpp"
#include "scene/build/build.hpp"
#include "scene/build/build_parts.hpp"
#include "sensitivity/target_attraction.hpp"

#include <algorithm>
#include <array>

namespace coapt {
namespace {

// By which the pressure moves a leaflet against the springs [mm]: some of its edges, then as good as free.
// Stiffer springs took more iterations, one stage alone more closures.
constexpr std::array kGiving = {0.3, 3.0};
constexpr int kSolves = 6;                    // of each of these, at most
constexpr double kStep = 1e-2, kGain = 1e-2;  // where each ends: the next begins from there anyway

// The model with springs.
struct Drawn {
  Model model;
  TargetAttraction* springs = nullptr;  // of the model
};

Drawn draw(const PreparedTuning& ready, const Points& x, const TriangleMesh& target) {
  Drawn drawn;
  drawn.model = build(ready.scene, ready.geometry, [&](const Model& own) {
    auto springs = std::make_unique<TargetAttraction>("target attraction", own.mesh.triangles, x, target);
    drawn.springs = springs.get();
    std::vector<std::unique_ptr<EnergyTerm>> terms;
    terms.push_back(std::move(springs));
    return terms;
  });
  return drawn;
}

}  // namespace

TuningStart approach_target(const PreparedTuning& ready, const Model& model, const TriangleMesh& target,
                            const TuningGoal& goal, const TuningOptions& options, const TuningRecord& first) {
  const double begin_s = wall_seconds();
  TuningStart found;
  if (!(model.applied_pressure > 0)) return found;
  const Points x = model.objective->positions(first.q);
  Drawn drawn = draw(ready, x, target);
  const EquilibriumMaker make = equilibrium_maker(ready, drawn.model, false);
  Vector value = first.value, q = problem_at(x, drawn.model).q0;
  const EquilibriumMaker make_at_value = [&](const Vector& unknowns) {
    auto equilibrium = make(unknowns);
    equilibrium->set(value);
    return equilibrium;
  };
  const auto add = [&](TuningTrial trial) {
    trial.is_aided = true;
    trial.is_best = false;
    trial.cost = kInfinity;
    trial.seconds = first.seconds + wall_seconds() - begin_s;
    if (options.report) options.report(trial);
    found.trials.push_back(std::move(trial));
  };
  // No chord is changed before the leaflets are where the target is.
  drawn.springs->set_stiffness(model.applied_pressure / kGiving.front());
  const auto equilibrium = make_at_value(q);
  const WarmSolve solved = equilibrium->solve();
  q = equilibrium->unknowns();
  add({.value = value, .status = solved.status, .iterations = solved.iterations});
  if (solved.status != Status::Converged) return found;

  const auto method = built_in_minimisers().at("gauss_newton")();
  for (const double giving : kGiving) {
    drawn.springs->set_stiffness(model.applied_pressure / giving);
    drawn.springs->face(drawn.model.objective->positions(q));
    if (const auto taut = with_slack_taken_up(ready, drawn.model, options.low, value, q)) value = *taut;
    TuningOptions own = options;
    own.stop.step = std::max(kStep, options.stop.step);
    own.stop.gain = std::max(kGain, options.stop.gain);
    own.max_solves =
        std::min(kSolves, options.max_solves - static_cast<int>(first.history.size() + found.trials.size()));
    own.max_seconds = options.max_seconds - (wall_seconds() - begin_s);
    own.report = add;
    own.keep = {};
    own.start = {};
    own.restart = {};
    own.known = nullptr;
    if (own.max_solves < 1 || !(own.max_seconds > 0)) return found;
    const Tuning stage = tune(make_at_value, q, goal, *method, own);
    if (stage.status != TuningStatus::Converged && stage.status != TuningStatus::Stalled &&
        (stage.status != TuningStatus::SolveLimit || own.max_solves < kSolves))
      return found;
    value = stage.best.value.cwiseMax(options.low).cwiseMin(options.high);
    q = stage.best.q;
  }
  found.value = value;
  found.q = q;
  return found;
}

}  // namespace coapt
