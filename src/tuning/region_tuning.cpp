#include "tuning/region_tuning.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "core/timing.hpp"
#include "results/orifice_area.hpp"
#include "results/standing.hpp"
#include "scene/build/build.hpp"
#include "scene/build/scene_geometry.hpp"
#include "solve/solve_scene.hpp"
#include "tuning/detail/region_factors.hpp"
#include "tuning/detail/yield_excess.hpp"
#include "tuning/tuned_scene.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kOrificeShare = 0.02;  // of the annulus area: the limit where none is given
constexpr double kLeastStep = 1e-3;     // of a logarithm
constexpr double kLeastGain = 1e-3;     // of the sum of squares
constexpr double kFirstDamping = 1;     // high: of many factors that do it, those near 1 are wanted
constexpr int kPatience = 100;          // iterations

void check(const RegionTuningOptions& options) {
  std::vector<std::string> defects;
  if (options.yield_strain && !(*options.yield_strain > 0))
    defects.emplace_back("--yield-strain: must be above 0");
  if (!(options.greatest_factor > 1)) defects.emplace_back("--greatest-factor: must be above 1");
  if (options.orifice_limit_mm2 && !(*options.orifice_limit_mm2 > 0))
    defects.emplace_back("--orifice: must be an area above 0");
  if (!defects.empty()) throw InputError(defects);
}

bool is_good(const TuningState& state, const std::optional<double>& orifice_limit_mm2) {
  return state.strained_chords + state.strained_facets == 0 &&
         !(orifice_limit_mm2 && state.orifice_area_mm2 && *state.orifice_area_mm2 > *orifice_limit_mm2);
}

bool has_yield(const Model& model) {
  return std::any_of(model.lines.begin(), model.lines.end(),
                     [](const Line& line) { return std::isfinite(line.yield_strain); }) ||
         std::any_of(model.membrane_patches.begin(), model.membrane_patches.end(),
                     [](const MembranePatch& patch) { return patch.yield_ratio != nullptr; });
}

std::string refusal(const RegionTuning& found, const RegionTuningOptions& options) {
  return "no factors from " + number_text(1 / options.greatest_factor, 6) + " to " +
         number_text(options.greatest_factor, 6) +
         " were found: " + std::to_string(found.after.strained_chords) + " chords " +
         (options.yield_strain ? "stay above a strain of " + number_text(*options.yield_strain, 6) +
                                     ", the most at " + fixed_text(found.after.max_chord_strain, 4)
                               : "and " + std::to_string(found.after.strained_facets) +
                                     " facets stay beyond their yield, the most at " +
                                     fixed_text(found.after.max_yield_ratio, 3) + " times it") +
         ", with an orifice of " + fixed_text(found.after.orifice_area_mm2.value_or(0), 2) + " mm2 (limit " +
         fixed_text(found.orifice_limit_mm2.value_or(0), 2) + ")";
}

// From the scene's own equilibrium, which exceeds a limit.
Tuning search(const TunedScene& tuned, const RegionTuningOptions& options, const SolveSetup& setup,
              const Result& first, Model& model, const RegionTuning& found) {
  const YieldExcess excess(model, options.yield_strain, found.orifice_limit_mm2);
  TrackingOptions tracking;
  tracking.factorisation = setup.factorisation;
  tracking.tolerance = setup.stop.tolerance;
  tracking.max_seconds = setup.stop.max_seconds;
  tracking.observer = setup.observer;
  // A change that takes far longer than the whole is a change for the worse.
  tracking.max_iterations = std::min(setup.stop.max_iterations, kPatience + 3 * first.iterations);
  const EquilibriumMaker make = region_factor_maker(tuned, model, tracking);

  TuningOptions own;
  own.high = Vector::Constant(tuned.factor_count(), std::log(options.greatest_factor));
  own.low = -own.high;
  own.stop = {kLeastStep, kLeastGain, YieldExcess::enough(), kFirstDamping};
  own.max_solves = options.max_solves;
  own.is_cancelled = [&] { return setup.observer && !setup.observer({}, first.q); };
  if (options.report)
    own.keep = [&, round = 0](const TuningRecord& record) mutable {
      if (!record.history.back().is_best || record.history.size() == 1) return;
      options.report(++round,
                     tuning_state(model, model.objective->positions(record.q), options.yield_strain));
    };
  return tune(make, first.q, {.residuals = &excess}, *built_in_minimisers().at("gauss_newton")(), own);
}

// Of a solve, with what is doubtful about it.
TuningState solved_state(const Model& model, const Result& result, const RegionTuningOptions& options,
                         const IntersectionChecker& checker) {
  const Points x = model.objective->positions(result.q);
  TuningState state = tuning_state(model, x, options.yield_strain);
  const Fields fields = compute_fields(model, x);
  state.doubts = doubts(model, result, fields, measure(model, result.q, fields, checker));
  return state;
}

// The scene with the factors that were found, built anew and solved from where the search ended.
void finish(const TunedScene& tuned, const RegionTuningOptions& options, const SolveSetup& setup,
            const IntersectionChecker& checker, const Points& x, const Vector& factors, RegionTuning& found) {
  Model model = build(tuned.scene(factors), tuned.geometry);
  const Result last = solve_again(x, model, setup);
  ++found.solves;
  found.after = solved_state(model, last, options, checker);
  if (last.status != Status::Converged) {
    ++found.failed_solves;
    found.message = "the scene with the factors that were found is not solved: " + last.message;
  } else if (is_good(found.after, found.orifice_limit_mm2)) {
    found.is_reached = true;
    found.message = options.yield_strain ? "no chord exceeds its yield strain any more"
                                         : "no chord and no facet exceeds its yield any more";
  } else {
    found.message = refusal(found, options);
  }
}

// Pre: the scene itself is solved and exceeds a limit. Returns the factors.
Vector tune_factors(const TunedScene& tuned, const RegionTuningOptions& options, const SolveSetup& setup,
                    const IntersectionChecker& checker, const Result& first, Model& model,
                    RegionTuning& found) {
  const Tuning tuning = search(tuned, options, setup, first, model, found);
  found.solves += tuning.solves - 1;  // the first trial is the first solve
  found.failed_solves = tuning.failed;
  for (const TuningTrial& trial : tuning.best.history) found.rounds += trial.is_best ? 1 : 0;
  found.rounds = std::max(0, found.rounds - 1);
  Vector factors = tuning.best.value.array().exp();
  if (found.rounds > 0)
    finish(tuned, options, setup, checker, model.objective->positions(tuning.best.q), factors, found);
  else if (tuning.status == TuningStatus::NoStart || tuning.jacobian.size() == 0)
    found.message = "the derivatives by the factors are not known: " + tuning.message;
  else if (tuning.jacobian.isZero(0))
    found.message = "no factor changes what is too much";
  else if (tuning.failed > 0 && tuning.failed + 1 == tuning.solves)
    found.message = "no solve with changed factors converged";
  else
    found.message = refusal(found, options);
  if (tuning.status == TuningStatus::Cancelled) found.message = "cancelled";
  return factors;
}

}  // namespace

RegionTuning tune_regions(const Scene& scene, const SolverTable& solvers, const RegionTuningOptions& options,
                          const RunOptions& run) {
  const double start = wall_seconds();
  check(options);
  const SolveSetup setup = solve_setup(scene, solvers, run);
  SceneGeometry geometry = scene_geometry(scene);
  const Model own = build(scene, geometry);  // for its defects, in the scene's own words
  if (options.orifice_limit_mm2 && annulus_of(own) == nullptr)
    throw InputError("--orifice: " + scene.file.string() +
                     ": has no node set \"annulus\", so that no orifice is measured; leave it out");
  if (!options.yield_strain && !has_yield(own))
    throw InputError("--yield-strain: missing, and no term of " + scene.file.string() +
                     " has a `yield_strain`; give one of them");
  const TunedScene tuned(scene, std::move(geometry), options);

  RegionTuning found;
  found.scene_file = scene.file.filename().string();
  found.yield_strain = options.yield_strain;
  Vector factors = Vector::Ones(tuned.factor_count());
  const Scene split = tuned.scene(factors);
  Model model = build(split, tuned.geometry);
  const Result first = solve_scene(split, tuned.geometry, model, setup).result;
  const Points x = model.objective->positions(first.q);
  found.solves = 1;
  found.before = found.after = solved_state(model, first, options, run.checker);
  found.orifice_limit_mm2 = options.orifice_limit_mm2;
  if (const std::optional<OrificeArea> area = orifice_area(model, x); area && !found.orifice_limit_mm2)
    found.orifice_limit_mm2 = kOrificeShare * area->annulus;
  if (first.status != Status::Converged) {
    found.failed_solves = 1;
    found.message = "the scene itself is not solved: " + first.message;
  } else if (is_good(found.before, found.orifice_limit_mm2)) {
    found.is_reached = true;
    found.message = "nothing to tune";
  } else {
    factors = tune_factors(tuned, options, setup, run.checker, first, model, found);
  }
  found.region_of_triangle = tuned.geometry.model.mesh.regions;
  tuned.name_factors(factors, found.regions, found.chords);
  found.wall_s = wall_seconds() - start;
  return found;
}

}  // namespace coapt
