#include "tuning/chord_tuning.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "formats/whole_file.hpp"
#include "run/run_parts.hpp"
#include "scene/build/build.hpp"
#include "scene/file/scene_text.hpp"
#include "sensitivity/parameters/line_access.hpp"
#include "tuning/chord_tuning_approach.hpp"
#include "tuning/chord_tuning_goal.hpp"
#include "tuning/tracked_scene.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace coapt {
namespace {

constexpr const char* kTunedScene = "tuned.json";
constexpr double kAtBound = 1e-9;
constexpr double kClearlyTaut = 3;    // standard deviations of the length
constexpr double kLeastMisfit = 0.1;  // of the least step: a fit that is closer is at its end

// The sum over the chords of the squared change is that of z, the mean of the group, times this.
double squares(const ChordGroup& group, const std::vector<TunableChord>& chords) {
  double sum = 0;
  for (const size_t k : group.chords) sum += chords[k].length * chords[k].length;
  return sum / (group.length * group.length);
}

TuningOptions tuning_options(const PreparedTuning& ready, const ChordTuningOptions& options,
                             const Points& x_before) {
  const auto count = static_cast<Eigen::Index>(ready.groups.size());
  TuningOptions own;
  own.low = Vector::Constant(count, 1 + options.lowest);
  own.high = Vector::Constant(count, 1 + options.highest);
  own.scales.resize(count);
  for (Eigen::Index g = 0; g < count; ++g) own.scales[g] = ready.groups[static_cast<size_t>(g)].length;
  own.stop = {options.step, options.gain,
              distance_weight_of(options) * std::pow(kLeastMisfit * options.step, 2)};
  own.max_solves = options.max_solves - 1;
  own.max_seconds = options.max_seconds;
  own.is_cancelled = options.is_cancelled;
  if (options.report) {
    const auto trials = std::make_shared<int>(
        options.known != nullptr ? static_cast<int>(options.known->tuning.history.size()) : 0);
    own.report = [&options, trials](const TuningTrial& trial) { options.report(1 + ++*trials, trial); };
  }
  if (options.keep)
    own.keep = [&options, x_before](const TuningRecord& record) { options.keep({record, x_before}); };
  if (options.known != nullptr) own.known = &options.known->tuning;
  return own;
}

bool is_slack(const ChordGroup& group, const std::vector<TunableChord>& chords, const Fields& fields) {
  for (const size_t k : group.chords)
    for (const size_t line : chords[k].lines)
      if (fields.line_force[static_cast<Eigen::Index>(line)] > 0) return false;
  return true;
}

// Of its most extended line, beyond its rest length [mm].
double extension(const ChordGroup& group, const std::vector<TunableChord>& chords, const RunReport& run) {
  double most = 0;
  for (const size_t k : group.chords)
    for (const size_t at : chords[k].lines) {
      const Line& line = run.model.lines[at];
      most = std::max(most, line_strain(line, run.report.fields.x).value_or(0) * line.rest_length);
    }
  return most;
}

// Mean square distance at the best trial [mm2].
double least_misfit(const TuningRecord& record) {
  double least = kInfinity, misfit = kNaN;
  for (const TuningTrial& trial : record.history)
    if (trial.cost < least) {
      least = trial.cost;
      misfit = trial.misfit;
    }
  return misfit;
}

std::vector<TunedLength> tuned_lengths(const PreparedTuning& ready, const ChordTuningOptions& options,
                                       const Vector& factors, const std::optional<Determinacy>& determinacy,
                                       const RunReport& run) {
  std::vector<TunedLength> lengths;
  for (size_t g = 0; g < ready.groups.size(); ++g) {
    const ChordGroup& group = ready.groups[g];
    const auto at = static_cast<Eigen::Index>(g);
    TunedLength length{.name = group.name, .chords = static_cast<int>(group.chords.size())};
    length.before = group.length;
    length.factor = factors[at];
    length.after = length.factor * length.before;
    length.low = (1 + options.lowest) * length.before;
    length.high = (1 + options.highest) * length.before;
    length.at_bound = length.after <= length.low * (1 + kAtBound)    ? -1
                      : length.after >= length.high * (1 - kAtBound) ? 1
                                                                     : 0;
    length.is_slack = is_slack(group, ready.chords, run.report.fields);
    length.extension = extension(group, ready.chords, run);
    if (determinacy) {
      length.deviation = determinacy->deviation[at];
      // Then it fits as well without a pull, at any greater length. Where nothing is known of the length,
      // nothing is known of that either.
      length.is_hardly_taut =
          std::isfinite(length.deviation) && !(length.extension > kClearlyTaut * length.deviation);
      length.is_determined = length.deviation <= options.determined && !length.is_hardly_taut;
    }
    lengths.push_back(std::move(length));
  }
  return lengths;
}

bool was_drawn(const TuningRecord* known) {
  if (known == nullptr || known->history.back().is_aided) return false;
  return std::any_of(known->history.begin(), known->history.end(),
                     [](const TuningTrial& trial) { return trial.is_aided; });
}

// A fit goes by way of springs to the target where chords are slack, or where it ends elsewhere without them.
Tuning search(const PreparedTuning& ready, RunReport& before, const TuningGoal& goal,
              BoundedMinimiser& method, const ChordTuningOptions& options, TuningOptions own) {
  const double begin_s = wall_seconds(), seconds = own.max_seconds;
  const Vector& q = before.report.result.q;
  const EquilibriumMaker make = equilibrium_maker(ready, before.model, true);
  const auto is_close = [&](const TuningRecord& best) {
    return !(least_misfit(best) > options.step * options.step);
  };
  if (goal.residuals != nullptr)
    own.restart = [&](const TuningRecord& best) -> std::optional<Vector> {
      if (is_close(best)) return std::nullopt;
      return with_slack_taken_up(ready, before.model, own.low, best.value, best.q);
    };
  if (options.is_direct || goal.residuals == nullptr || !goal.metrics.empty() || was_drawn(own.known))
    return tune(make, q, goal, method, own);

  const TriangleMesh target = read_target(options, before.model);
  const auto approach = [&](const TuningRecord& best) {
    return approach_target(ready, before.model, target, goal, own, best);
  };
  const bool has_slack = std::any_of(ready.groups.begin(), ready.groups.end(), [&](const ChordGroup& group) {
    return is_slack(group, ready.chords, before.report.fields);
  });
  if (has_slack) own.start = approach;
  Tuning found = tune(make, q, goal, method, own);
  const bool has_ended = found.status == TuningStatus::Converged || found.status == TuningStatus::Stalled;
  own.max_seconds = seconds - (wall_seconds() - begin_s);
  if (has_slack || !has_ended || is_close(found.best) || !(own.max_seconds > 0)) return found;
  const TuningRecord known = found.best;
  own.known = &known;
  own.start = approach;
  return tune(make, q, goal, method, own);
}

void note_options(const ChordTuningOptions& options, const BoundedMinimiser& method, ChordTuning& found) {
  found.method = method.name();
  found.distance_weight = distance_weight_of(options);
  found.orifice_weight = options.orifice_weight;
  found.force_weight = options.force_weight;
  found.change_weight = change_weight_of(options);
  found.noise = options.noise;
  found.determined = options.determined;
  if (found.distance_weight > 0)
    found.target = options.target.empty() ? "reference.closed_surface of the scene" : options.target.string();
}

// The scene with the best factors, written beside the report and solved again from where the search ended.
void solve_tuned(const std::string& text, const std::filesystem::path& scene, const PreparedTuning& ready,
                 const SolverTable& solvers, RunOptions options, ChordTuning& found) {
  found.tuned_scene = kTunedScene;
  const std::filesystem::path file = found.folder / kTunedScene;
  formats::write_whole(
      file, tuned_scene_text(text, scene, found.folder, ready.chords, ready.groups, found.tuning.best.value));
  const Scene tuned = load_scene(file);
  const SceneGeometry geometry = scene_geometry(tuned);
  RunReport& after = found.after.emplace();
  after.model = build(tuned, geometry);
  options.folder = found.folder / "tuned";
  options.observer = {};  // whoever interrupted the tuning wants what it found
  const Points x = found.before.model.objective->positions(found.tuning.best.q);
  after.folder = open_result_folder(tuned, options);
  after.report = run_built(tuned, geometry, solve_setup(tuned, solvers, options), options, after.model,
                           after.folder, &x);
  ++found.solves;
}

}  // namespace

bool ChordTuning::has_converged() const {
  return tuning.status == TuningStatus::Converged && after &&
         after->report.result.status == Status::Converged;
}

double ChordTuning::misfit_before() const {
  return tuning.best.history.empty() ? kNaN : std::sqrt(tuning.best.history.front().misfit);
}

double ChordTuning::misfit_after() const { return std::sqrt(least_misfit(tuning.best)); }

ChordTuning tune_chords(const std::filesystem::path& scene, const SolverTable& solvers,
                        const BoundedMinimiserTable& minimisers, const ChordTuningOptions& options,
                        const RunOptions& run_options) {
  const double start = wall_seconds();
  const std::string text = scene_text(scene);
  ChordTuning found;
  found.scene_file = scene.filename().string();
  Model& model = found.before.model;
  const PreparedTuning ready = prepare_tuning(text, scene, solvers, minimisers, options, run_options, model);
  found.scene_title = scene_title(ready.scene);
  const std::unique_ptr<BoundedMinimiser> method = minimisers.at(chord_tuning_method(options))();
  note_options(options, *method, found);
  found.folder = run_options.folder.empty() ? result_folder(ready.scene) : run_options.folder;
  prepare_result_folder(found.folder);

  RunOptions own = run_options;
  own.folder = found.folder / "untuned";
  found.before.folder = open_result_folder(ready.scene, own);
  found.before.report = run_built(ready.scene, ready.geometry, ready.setup, own, model, found.before.folder,
                                  options.known != nullptr ? &options.known->x_before : nullptr);
  if (options.report_before) options.report_before(found.before);
  const Fields& fields = found.before.report.fields;
  found.solves = 1;
  const auto count = static_cast<Eigen::Index>(ready.groups.size());
  if (found.before.report.result.status != Status::Converged) {
    found.tuning.status = found.before.report.result.status == Status::Cancelled ? TuningStatus::Cancelled
                                                                                 : TuningStatus::NoStart;
    found.tuning.message = "the scene itself is not solved: " + found.before.report.result.message;
    found.lengths = tuned_lengths(ready, options, Vector::Ones(count), {}, found.before);
    found.seconds = wall_seconds() - start;
    return found;
  }

  ChordTuningGoal made = make_chord_tuning_goal(options, model, fields, ready.lines);
  made.goal.change_weights.resize(count);
  for (Eigen::Index g = 0; g < count; ++g)
    made.goal.change_weights[g] =
        found.change_weight * squares(ready.groups[static_cast<size_t>(g)], ready.chords);
  TuningOptions tuning = tuning_options(ready, options, fields.x);
  tuning.max_seconds = std::max(1e-3, options.max_seconds - (wall_seconds() - start));
  found.tuning = search(ready, found.before, made.goal, *method, options, tuning);
  found.solves += found.tuning.solves;
  take_rest_lengths(model);
  if (found.tuning.jacobian.size() > 0) {
    const Vector noise = options.noise * made.residuals->noise_factors();
    found.determinacy = determinacy(found.tuning.jacobian,
                                    std::sqrt(static_cast<double>(made.residuals->repetitions())) * noise);
    found.is_explained =
        is_explained_by_noise(found.tuning.residuals, noise,
                              made.residuals->patch_sums(found.tuning.residuals.cwiseQuotient(noise)));
  }

  solve_tuned(text, scene, ready, solvers, own, found);
  found.lengths = tuned_lengths(ready, options, found.tuning.best.value, found.determinacy, *found.after);
  // A fit that the noise does not explain is trapped, or the model is another: it determines nothing.
  if (!found.is_explained)
    for (TunedLength& length : found.lengths) length.is_determined = false;
  found.seconds = (options.known != nullptr ? options.known->tuning.seconds : 0) + wall_seconds() - start;
  return found;
}

}  // namespace coapt
