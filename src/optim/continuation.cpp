#include "optim/continuation.hpp"

#include "core/number_text.hpp"
#include "optim/harmonic_extension.hpp"
#include "optim/move_prescribed.hpp"
#include "optim/stability/branch_watch.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr int kMaxOuterIterations = 100;            // renewals of a load without potential
constexpr int kMaxOuterIterationsWithoutGain = 12;  // of them in a row that better nothing
constexpr double kMotionTolerance = 1e-2;           // residual at which an intermediate position is left
constexpr double kBranchTolerance = 1e-4;  // and an intermediate load, which has to stay on its branch
constexpr int kLeastPath = 3;              // steps of a path on which a change of branch can be told
constexpr int kMostStiffenings = 5;        // of a contact that proves too soft

// Loads and stiffnesses at t of the path.
void set_scales(const Continuation& continuation, double t, Objective& objective) {
  objective.scale(continuation.load_steps > 1 ? t : 1,
                  continuation.stiffness_steps > 1 ? std::pow(continuation.first_stiffness, 1 - t) : 1);
}

// How the path is walked back where a step may have left its branch. The references must outlive it.
PathMeans path_means(Solver& solver, const Problem& problem, const StopRule& stop, Monitor& monitor,
                     int& outer_iterations) {
  Objective& objective = problem.objective;
  const auto pose = [&](double t) {
    set_scales(problem.continuation, t, objective);
    if (problem.motion.positions) objective.prescribe(problem.motion.positions(t));
  };
  return {pose,
          [&, pose](double t, Vector& q) {
            if (problem.motion.positions) {
              const Points here = objective.positions(q);
              const Vector carried = extended_harmonically(objective, q, problem.motion.positions(t));
              pose(t);
              if (objective.step_limit(here, objective.positions(carried) - here, 1) < 1) return false;
              q = carried;
            }
            pose(t);
            return true;
          },
          [&](Vector& q) {
            std::string note;
            const Status status =
                run_outer_iterations(solver, objective, q, monitor, stop.tolerance, outer_iterations, note);
            return !ends_the_run(status) && objective.true_residual(q) <= stop.tolerance;
          }};
}

std::string described(const BranchChange& change) {
  return "the path left its branch of equilibria in step " + std::to_string(change.step) + "; at step " +
         std::to_string(change.before) + " the two are " + number_text(change.distance) + " apart";
}

}  // namespace

bool ends_the_run(Status status) {
  return status == Status::Cancelled || status == Status::TimeLimit || status == Status::IterationLimit ||
         status == Status::NonFinite || status == Status::NoEquilibrium;
}

Outcome blocked_motion(const MotionPath& motion, const Move& move, Objective& objective, const Vector& q) {
  Outcome outcome;
  outcome.is_short_of_full = true;
  const bool is_lost = move.is_overloaded && !is_finite(objective, q);
  outcome.status = is_lost ? Status::NonFinite : Status::Stalled;
  const std::string parts = blocked_parts(motion, move.reached, objective, q);
  outcome.note =
      "the prescribed motion" + (parts.empty() ? "" : " of " + parts) +
      (move.is_overloaded ? " stretches an element until its energy is not finite, at "
                          : " presses facets against each other, at ") +
      number_text(100 * move.reached) + " % of it; end it before" +
      (move.is_overloaded ? ", or lengthen or soften what is stretched there"
                          : ", or lead it around by more stations, or move what is in its way along");
  return outcome;
}

std::string lost_motion(const MotionPath& motion, double reached) {
  std::string names;
  for (const MotionPath::Part& part : motion.parts) names += (names.empty() ? " of " : ", ") + part.name;
  return "with the prescribed motion" + names + " at " + number_text(100 * reached) +
         " % of it; end it before, take it in more steps, or lengthen or soften what it stretches";
}

Status run_outer_iterations(Solver& solver, Objective& objective, Vector& q, Monitor& monitor,
                            double tolerance, int& outer_iterations, std::string& note) {
  if (!objective.has_circulatory_force() || solver.follows_path()) {
    for (int stiffening = 0;; ++stiffening) {
      if (objective.has_circulatory_force()) objective.set_path_anchor(q);
      monitor.begin_outer_iteration(monitor.outer_iteration() + 1, tolerance);
      const Status status = solver.minimize(objective, q, monitor);
      if (ends_the_run(status) || stiffening == kMostStiffenings || !objective.escalate_stiffness(q))
        return status;
    }
  }
  Vector best = q;
  double best_residual = kInfinity, gained_residual = kInfinity;
  double last_residual = kInfinity, contraction = kNaN;
  int without_gain = 0;
  for (int renewal = 0; renewal < kMaxOuterIterations; ++renewal) {
    objective.lag_circulatory_force(q);
    const double residual = objective.true_residual(q);
    without_gain = residual < 0.9 * gained_residual ? 0 : without_gain + 1;
    if (without_gain == 0) gained_residual = residual;
    if (residual < best_residual) {
      best_residual = residual;
      best = q;
    }
    if (renewal > 0) contraction = residual / last_residual;
    last_residual = residual;
    if (residual <= tolerance) return Status::Converged;
    if (without_gain >= kMaxOuterIterationsWithoutGain) break;
    ++outer_iterations;
    monitor.begin_outer_iteration(monitor.outer_iteration() + 1,
                                  std::max(0.5 * tolerance, 0.1 * std::min(residual, 1.0)));
    const Status status = solver.minimize(objective, q, monitor);
    if (ends_the_run(status)) return status;
  }
  q = best;
  note = "the outer iterations of the follower pressure on free edges did not converge (last contraction " +
         number_text(contraction) + " an iteration)";
  return Status::Stalled;
}

Outcome run_continuation(Solver& solver, const Problem& problem, const StopRule& stop, Monitor& monitor,
                         Result& result) {
  Objective& objective = problem.objective;
  const Continuation& continuation = problem.continuation;
  const bool is_continued = std::max(continuation.load_steps, continuation.stiffness_steps) > 1;
  const bool is_taken = problem.motion.positions && !is_continued && solver.takes_motion(problem.motion);
  const bool has_motion = problem.motion.positions && !is_taken;
  const int steps = std::max(
      {1, has_motion ? problem.motion.steps : 1, continuation.load_steps, continuation.stiffness_steps});
  const double on_path = std::max(stop.tolerance, is_continued ? kBranchTolerance : kMotionTolerance);
  BranchWatch branches(path_means(solver, problem, stop, monitor, result.outer_iterations));
  Outcome outcome;
  Move move;
  bool is_blocked = false, has_arrived = true;
  int step = 1;
  for (; step <= steps; ++step) {
    const double t = static_cast<double>(step) / steps;
    has_arrived = !has_motion;
    do {
      if (!has_arrived) {
        if (solver.raises_stress_limits()) objective.limit_stress(result.q);
        const double moved = move.reached;
        move = move_prescribed(problem.motion, moved, t, objective, result.q);
        has_arrived = move.reached == t;
        is_blocked = !has_arrived && move.reached - moved < kLeastMotion;
        if (is_blocked) break;
      }
      set_scales(continuation, t, objective);
      if (has_motion || steps > 1) monitor.set_path(has_motion ? move.reached : t);
      const bool is_last = has_arrived && step == steps;
      outcome.status =
          run_outer_iterations(solver, objective, result.q, monitor, is_last ? stop.tolerance : on_path,
                               result.outer_iterations, outcome.note);
    } while (!has_arrived && !ends_the_run(outcome.status));
    if (is_blocked || ends_the_run(outcome.status)) break;
    if (steps < kLeastPath) continue;
    if (const auto change = branches.arrive(step, t, result.q)) {
      result.branch_changes.push_back(*change);
      outcome.note = described(*change);
    }
    if (monitor.is_cancelled()) {
      outcome.status = Status::Cancelled;
      break;
    }
  }
  // A run that was cut short is measured, with the full load, and kept, where it had got to.
  objective.scale(1, 1);
  if (is_blocked) return blocked_motion(problem.motion, move, objective, result.q);
  outcome.is_short_of_full = step < steps || !has_arrived;
  if (has_motion && outcome.status == Status::NonFinite)
    outcome.note = lost_motion(problem.motion, move.reached);
  else if (!has_arrived)
    outcome.note = "after " + number_text(100 * move.reached) + " % of the prescribed motion";
  else if (outcome.is_short_of_full)
    outcome.note = "step " + std::to_string(step) + " of " + std::to_string(steps) +
                   " of the prescribed motion or of the continuation";
  return outcome;
}

}  // namespace coapt
