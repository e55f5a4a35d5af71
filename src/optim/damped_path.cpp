#include "optim/damped_path.hpp"

#include "linear/factorisation.hpp"
#include "optim/move_prescribed.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <memory>

namespace coapt {
namespace {

constexpr double kTravel = 0.2;  // of the extent, by which its share of the loads moves a node in one step
constexpr double kStepTolerance = 1e-4;  // residual of a step, dampers included
constexpr double kAtRest = 1e-4;         // residual without dampers at which they go
constexpr double kStableAtRest = 1e-3;   // the same on a finer mesh, where the shape is stable without them
constexpr double kFollows = 1e-3;        // drag of the dampers on a shape that all but follows its loads
constexpr int kFirstShares = 3;          // of the loads' equal shares in the first step
constexpr int kFirstOf = 6;              // and no more than all of them over this
constexpr int kGrowth = 2;               // of their number in one step, after a step to a stable shape
constexpr int kMostShares = 8;           // in one step
constexpr double kNearEnd = 10;          // damping of a path that begins near its end, over that of others
constexpr double kMostFall = 0.5;        // of the damping, from one step to the next at the full problem
constexpr double kStableFall = 0.01;     // the same where the shape is stable without dampers
constexpr double kHold = 1e-4;         // of the first damping: holds free nodes where stability is asked for
constexpr double kLate = 0.5;          // of the loads: from there on unstable steps are counted
constexpr int kMostStepsAtRest = 200;  // at the full problem
constexpr double kLost = 1;            // residual of a loaded start whose first steps lead nowhere
constexpr int kMostInStep =
    200;  // iterations of a step from a loaded start; a start that needs more is given up
constexpr int kMostWithoutMotion = 3;  // steps in a row in which the prescribed motion gets no further

class DampedPath {
 public:
  DampedPath(Solver& solver, const Problem& problem, const StopRule& stop, Monitor& monitor, Result& result)
      : solver_(solver), problem_(problem), stop_(stop), monitor_(monitor), result_(result) {}

  Outcome follow() {
    Objective& objective = problem_.objective;
    const double extent = objective.extent(result_.q), nodes = static_cast<double>(result_.q.size()) / 3;
    if (extent > 0 && nodes > 0) damping_ = objective.total_load(result_.q) / (kTravel * extent * nodes);
    if (is_loaded()) {
      damping_ *= kNearEnd;
      moved_ = 1;
    }
    hold_ = kHold * damping_;
    do take_step();
    while (!has_ended() && !is_at_rest());
    objective.scale(1, 1);
    if (!has_ended()) {
      outcome_.status = run_outer_iterations(solver_, objective, result_.q, monitor_, stop_.tolerance,
                                             result_.outer_iterations, outcome_.note);
    } else {
      outcome_.is_short_of_full = true;
      if (outcome_.status == Status::NonFinite && problem_.motion.positions && !is_blocked_)
        outcome_.note = lost_motion(problem_.motion, moved_);
      if (outcome_.note.empty())
        outcome_.note = "step " + std::to_string(result_.damped_steps) + " of the damped path";
    }
    return outcome_;
  }

 private:
  bool is_loaded() const { return problem_.continuation.is_loaded; }
  bool has_ended() const { return is_blocked_ || has_failed_ || ends_the_run(outcome_.status); }
  double load() const {
    if (is_loaded()) return 1;
    return static_cast<double>(taken_shares_) / problem_.continuation.damped_steps;
  }
  bool is_at_full_problem() const { return load() == 1 && moved_ == 1; }

  // Whether the dampers may go; weakens them by what the residual fell by, and more where the shape is
  // stable.
  bool is_at_rest() {
    if (!is_at_full_problem()) return false;
    const double residual = true_residual();
    if (!std::isfinite(residual)) outcome_.status = Status::NonFinite;
    const double at_rest = is_loaded() && is_stable_ ? kStableAtRest : kAtRest;
    if (residual <= std::max(at_rest, stop_.tolerance) || damping_ == 0) return true;
    if (++steps_at_full_problem_ > kMostStepsAtRest) return true;
    if (is_stable_)
      damping_ *= kStableFall;
    else if (residual_ < kInfinity)
      damping_ *= std::clamp(residual / residual_, kMostFall, 1.0);
    residual_ = residual;
    return false;
  }

  // Without dampers; infinite where a term that a program wrote throws.
  double true_residual() {
    try {
      return problem_.objective.true_residual(result_.q);
    } catch (const std::exception&) {
      return kInfinity;
    }
  }

  void take_step() {
    ++result_.damped_steps;
    Objective& objective = problem_.objective;
    raise_load();
    objective.scale(load(), 1);
    advance_motion();
    if (is_blocked_) return;
    if (!is_loaded()) monitor_.set_path(std::min(load(), moved_));
    const Vector before = result_.q;
    const double damping = damping_ / std::max(shares_, 1);  // a step of more shares takes as much more time
    objective.damp(Vector::Constant(result_.q.size(), damping), before);
    if (is_loaded()) monitor_.limit_iterations(kMostInStep);
    outcome_.status = run_outer_iterations(solver_, objective, result_.q, monitor_, kStepTolerance,
                                           result_.outer_iterations, outcome_.note);
    const bool is_slow = outcome_.status == Status::IterationLimit && monitor_.has_reached_limit();
    if (is_slow) outcome_.status = Status::Stalled;
    monitor_.lift_limit();
    drag_ = objective.relative_residual(result_.q, damping * (result_.q - before));
    objective.damp({}, {});
    has_failed_ = is_slow || (is_loaded() && outcome_.status != Status::Converged && true_residual() > kLost);
    if (!has_ended()) ask_for_stability();
  }

  // Whether the shape of the last step is stable without dampers: the Hessian is positive definite. From half
  // of the loads on counts the steps that are not.
  void ask_for_stability() {
    Objective& objective = problem_.objective;
    Vector g;
    SparseMatrix hessian;
    objective.damp(Vector::Constant(result_.q.size(), hold_), result_.q);
    const double energy = monitor_.hessian(result_.q, g, hessian, Projection::None);
    objective.damp({}, {});
    is_stable_ = false;
    if (!std::isfinite(energy)) return;
    PhaseTimer timer(monitor_.phases(), "certificate");
    const auto& make = problem_.stability.factorisation;
    const auto factor = make ? make() : make_multifrontal_factorisation();
    factor->analyse(hessian);
    monitor_.count_certificate(1);
    is_stable_ = factor->factorise(hessian);
    if (load() >= kLate && problem_.stability.factorisation)
      result_.unstable_steps = std::max(result_.unstable_steps, 0) + (is_stable_ ? 0 : 1);
  }

  // One share of the loads a step as long as the shape moves through what is unstable; more in the first, as
  // an open valve is stable, and after a step whose shape is stable or all but rests under its
  // loads, so that the dampers hardly pull. What decides is the shape, not how a method came to it, so that
  // all take the same steps.
  int next_shares() const {
    if (taken_shares_ == 0) return std::clamp(problem_.continuation.damped_steps / kFirstOf, 1, kFirstShares);
    const bool is_easy = is_stable_ || drag_ < kFollows;
    return std::clamp(is_easy ? kGrowth * shares_ : shares_ / kGrowth, 1, kMostShares);
  }

  void raise_load() {
    if (is_loaded()) return;
    shares_ = std::min(next_shares(), problem_.continuation.damped_steps - taken_shares_);
    taken_shares_ += shares_;
  }

  // What is pressed together or overstretched gives way in the next steps, up to a limit.
  void advance_motion() {
    if (!problem_.motion.positions) moved_ = load();
    if (moved_ >= load()) return;
    if (solver_.raises_stress_limits()) problem_.objective.limit_stress(result_.q);
    const Move move = move_prescribed(problem_.motion, moved_, load(), problem_.objective, result_.q);
    steps_without_motion_ = move.reached - moved_ < kLeastMotion ? steps_without_motion_ + 1 : 0;
    moved_ = move.reached;
    if (steps_without_motion_ < kMostWithoutMotion) return;
    is_blocked_ = true;
    outcome_ = blocked_motion(problem_.motion, move, problem_.objective, result_.q);
  }

  Solver& solver_;
  const Problem& problem_;
  const StopRule& stop_;
  Monitor& monitor_;
  Result& result_;
  Outcome outcome_;
  double damping_ = 0, hold_ = 0;      // of each unknown [force/length]; where stability is asked for
  int taken_shares_ = 0, shares_ = 1;  // of the loads: so far; in the last step
  double drag_ = 0;                    // of the dampers in the last step, relative as a residual is
  double moved_ = 0;                   // of the prescribed motion
  double residual_ = kInfinity;        // of the last step at the full problem
  int steps_at_full_problem_ = 0, steps_without_motion_ = 0;
  bool is_stable_ = false, is_blocked_ = false, has_failed_ = false;
};

}  // namespace

Outcome follow_damped_path(Solver& solver, const Problem& problem, const StopRule& stop, Monitor& monitor,
                           Result& result) {
  return DampedPath(solver, problem, stop, monitor, result).follow();
}

}  // namespace coapt
