// Whether warm steps have left the branch of equilibria that they began on.
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "sensitivity/tracked_equilibrium.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kPrediction = 1e-5;  // residual of the linear system of a prediction
constexpr double kSame = 1e-3;        // of the travel, that shapes of one branch may lie apart
constexpr double kNoise = 1e-6;       // of the extent: distances below say nothing
constexpr double kLoose = 1e-9;       // of the mean stiffness of a node: what is below does not hold it

}  // namespace

// Of held nodes: junctions of slack chords need not come back. Pre: the tangent is ready.
double TrackedEquilibrium::held_distance(const Points& x) const {
  const Points missed = positions() - x;
  Points stiffness = Points::Zero(3, x.cols());
  const Vector diagonal = system_.diagonal().cwiseAbs();
  Eigen::Index unknown = 0;
  for (Eigen::Index node = 0; node < x.cols(); ++node) {
    if (objective_.fixed().col(node).all()) continue;
    stiffness.col(node) = objective_.fixed().col(node).select(0, diagonal.segment<3>(unknown).array());
    unknown += 3;
  }
  double distance = 0;
  for (Eigen::Index node = 0; node < x.cols(); ++node)
    if (stiffness.col(node).maxCoeff() > kLoose * stiffness.mean())
      distance = std::max(distance, missed.col(node).norm());
  return distance;
}

// By the tangent at `from`, where the shape is; to the numbers `to`, which are those of the terms before and
// after.
Points TrackedEquilibrium::predicted_change(const Place& from, const Vector& to) {
  Points predicted = Points::Zero(3, from.x.cols());
  if (to != from.value) {
    assign(from.value);  // the derivatives by the numbers as they were
    try {
      predicted = predict(to - from.value, kPrediction);
    } catch (const InputError&) {  // from where it stands, then
    }
    assign(to);
  }
  // Prescribed nodes go all the way, whatever the prediction's rounding.
  return objective_.fixed().select(prescribed() - from.x, predicted);
}

// Back at a solved shape, with its numbers.
void TrackedEquilibrium::take_up(const Place& place) {
  assign(place.value);
  objective_.prescribe(place.x);
  q_ = place.q;
  kinks_.reset();
  is_tangent_ready_ = false;
  is_solved_ = true;
  solved_value_ = place.value;
  negative_modes_ = place.negative;
  residual_at(q_);
  ready_tangent();
}

void TrackedEquilibrium::anchor_here() {
  require_solved();
  anchor_ = Place{q_, positions(), value(), negative_modes_};
  steps_since_anchor_check_ = 0;
}

void TrackedEquilibrium::anchor_at(const Vector& value, const Vector& q) {
  require_sound(value);
  if (q.size() != q_.size())
    throw InputError("anchor: " + std::to_string(q.size()) + " unknowns were given; there are " +
                     std::to_string(q_.size()));
  const Vector here = this->value();
  assign(value);
  Points x = objective_.positions(q);
  for (const auto& parameter : parameters_) parameter->place(x);
  assign(here);
  anchor_ = Place{q, x, value, 0};
  steps_since_anchor_check_ = 0;
}

AnchorCheck TrackedEquilibrium::check_anchor() {
  require_solved();
  ready_tangent();
  AnchorCheck check;
  const Place now{q_, positions(), value(), negative_modes_};
  if (!anchor_) anchor_here();
  const Place anchor = *anchor_;
  check.travel = held_distance(anchor.x);
  steps_since_anchor_check_ = 0;
  const auto go = [this](const Place& from, const Place& to, double& distance) {
    take_up(from);
    assign(to.value);
    const WarmSolve solved = move_to(from, predicted_change(from, to.value));
    if (solved.status == Status::Converged) distance = held_distance(to.x);
    return solved.status;
  };
  try {
    check.status = go(now, anchor, check.back);
    if (check.status == Status::Converged) check.status = go(anchor, now, check.here);
  } catch (const InputError&) {  // a tangent that is singular
    check.status = Status::Stalled;
  }
  take_up(now);
  const double apart = std::max(check.back, check.here);
  check.is_same_branch = check.status == Status::Converged &&
                         apart <= std::max(kSame * check.travel, kNoise * objective_.extent(q_));
  if (check.status != Status::Converged)
    check.message = "could not be compared with the anchor: the solve in one step does not converge";
  else if (check.is_same_branch)
    check.message = "on the branch of the anchor: both paths lead to the same shape";
  else
    check.message =
        "has left the branch of the anchor: the same numbers reached at once give a shape up to " +
        number_text(apart) + " away";
  return check;
}

void TrackedEquilibrium::check_anchor_in_time(WarmSolve& report) {
  if (!anchor_) {
    anchor_ = Place{q_, positions(), value(), negative_modes_};
    return;
  }
  if (options_.anchor_steps == 0 || ++steps_since_anchor_check_ < options_.anchor_steps) return;
  if (!is_tangent_ready_) return;
  report.anchor = check_anchor();
  if (!report.anchor->is_same_branch) report.message += "; " + report.anchor->message;
}

}  // namespace coapt
