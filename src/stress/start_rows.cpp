// S8, S9, S10, S22: nothing to do, other starts, no supports, and the path there and back.
#include "core/number_text.hpp"
#include "stress/subject.hpp"

#include <algorithm>
#include <random>

namespace coapt {
namespace {

// x with up to `amount` added to each coordinate that no support prescribes.
Points shaken(const Points& x, const FixedMask& fixed, double amount) {
  std::mt19937 random(12345);
  Points moved = x;
  for (Eigen::Index k = 0; k < x.size(); ++k) {
    const double share = 2.0 * static_cast<double>(random()) / 4294967295.0 - 1;
    if (!fixed.reshaped()[k]) moved.reshaped()[k] += amount * share;
  }
  return moved;
}

// As far as the barrier lets the nodes go.
Points admissible(Model& model, const Points& from, const Points& to) {
  const double part = model.objective->step_limit(from, to - from, 1);
  return from + (part < 1 ? 0.5 * part : 1) * (to - from);
}

StressRow shaken_row(const SubjectPointer& subject, double share, bool is_quick) {
  return {"S9",
          subject->name,
          "started again from the solution, shaken by " + number_text(share) + " of the extent",
          kDistanceFromOwn,
          "",
          is_quick,
          [subject, share]() -> StressOutcome {
            if (auto outcome = no_yardstick(*subject)) return *outcome;
            StressRun& own = own_solution(*subject);
            const Points start = admissible(
                own.model, own.x, shaken(own.x, own.model.objective->fixed(), share * extent_of(*subject)));
            const StressRun solved = subject->bench.solve(own_scene(*subject), {.start = &start});
            return same_shape_as_own(*subject, solved, solved.x);
          }};
}

StressOutcome without_supports(StressSubject& subject) {
  constexpr int kMostIterations = 1000;  // within which it must be seen
  StressScene loose = copy_of(own_scene(subject));
  loose.scene.solver.max_iterations = std::min(loose.scene.solver.max_iterations, kMostIterations);
  Prescribed& prescribed = loose.geometry.prescribed;
  const FixedMask before = prescribed.fixed;
  prescribed.fixed.setConstant(false);
  prescribed.paths.clear();
  for (const int node : loose.geometry.model.obstacles.reshaped())
    prescribed.fixed.col(node).setConstant(true);
  // What belongs to no term was held for the sake of that alone.
  std::vector<bool> is_used(static_cast<size_t>(before.cols()), false);
  for (const int node : loose.geometry.model.mesh.triangles.reshaped())
    is_used[static_cast<size_t>(node)] = true;
  for (const auto& [path, placed] : loose.geometry.networks)
    for (const Chord& chord : placed.network.chords)
      for (const ChordEnd& end : {chord.from, chord.to})
        is_used[static_cast<size_t>(placed.node(end))] = true;
  for (int node = 0; node < before.cols(); ++node)
    if (!is_used[static_cast<size_t>(node)]) prescribed.fixed.col(node).setConstant(true);

  const double tolerance = tolerance_of(own_scene(subject));
  const StressRun solved = subject.bench.solve(loose);
  if (auto wrong = untruth(solved, tolerance)) return *wrong;
  if (solved.result.status == Status::Converged) {
    const double residual = fresh_residual(loose, solved.x);
    return measured(solved, residual > 0 ? residual : solved.result.residual, kResidualSlack * tolerance,
                    "called converged, but a new objective measures another residual");
  }
  const bool is_named = solved.result.status == Status::NoEquilibrium;
  return outcome_of(solved, is_named ? StressVerdict::Pass : StressVerdict::Stall, solved.result.message);
}

StressOutcome with_every_node_held(StressSubject& subject) {
  StressScene held = copy_of(own_scene(subject));
  held.geometry.prescribed.fixed.setConstant(true);
  held.geometry.prescribed.paths.clear();
  const StressRun solved = subject.bench.solve(held);
  if (auto outcome = not_converged(solved, tolerance_of(held))) return *outcome;
  return measured(solved, solved.result.iterations, 0, "looked for what was there already");
}

// Solved on from the own solution in the changed scene, and from there in the scene as it is.
StressOutcome there_and_back(StressSubject& subject, const StressScene& changed) {
  const StressRun there = subject.bench.solve(changed, {.start = &own_solution(subject).x});
  if (auto outcome = not_converged(there, tolerance_of(own_scene(subject)))) return *outcome;
  const StressRun back = subject.bench.solve(own_scene(subject), {.start = &there.x});
  return same_shape_as_own(subject, back, back.x);
}

constexpr double kChange = 1.1;

StressOutcome longer_chords_and_back(StressSubject& subject) {
  if (auto outcome = no_yardstick(subject)) return *outcome;
  if (own_scene(subject).geometry.networks.empty())
    return {StressVerdict::NotApplicable, {}, {}, "the scene has no network of chords"};
  return there_and_back(subject, with_chords_scaled(own_scene(subject), kChange));
}

StressOutcome more_load_and_back(StressSubject& subject) {
  if (auto outcome = no_yardstick(subject)) return *outcome;
  for (const TermSpec& term : own_scene(subject).scene.terms)
    if (term.parameters.has("forces"))
      return {StressVerdict::NotApplicable, {}, {}, "the loads are read from a file"};
  return there_and_back(subject, with_energy_scaled(own_scene(subject), kChange, is_load));
}

}  // namespace

std::vector<StressRow> start_rows(const SubjectPointer& subject) {
  return {{"S8", subject->name, "every node held", "iterations", "", true,
           [subject] { return with_every_node_held(*subject); }},
          shaken_row(subject, 1e-6, true),
          shaken_row(subject, 1e-3, false),
          {"S10", subject->name, "all supports gone", "residual of what is called converged, measured anew",
           "", true, [subject] { return without_supports(*subject); }},
          {"S22", subject->name, "loads 10 % up, and back", kDistanceFromOwn, "", true,
           [subject] { return more_load_and_back(*subject); }},
          {"S22", subject->name, "chords 10 % longer, and back", kDistanceFromOwn, "", true,
           [subject] { return longer_chords_and_back(*subject); }}};
}

}  // namespace coapt
