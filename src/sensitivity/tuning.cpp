#include "sensitivity/tuning.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "sensitivity/detail/tuning_trials.hpp"

#include <cmath>

namespace coapt {
namespace {

constexpr double kBetter =
    0.99;  // of the cost before, that a new beginning must come below to be followed by another

// The method from the first numbers, and from others where it may have been trapped.
BoundedOutcome minimise(TuningTrials& trials, BoundedMinimiser& method, const TuningOptions& options) {
  BoundedOutcome outcome = method.minimise(trials, trials.first(), options.stop);
  for (double before = kInfinity; options.restart && !trials.end() && trials.least() < kBetter * before;) {
    const std::optional<Vector> again = options.restart(trials.record());
    if (!again) break;
    before = trials.least();
    const BoundedOutcome next = method.minimise(trials, again->cwiseProduct(options.scales), options.stop);
    if (trials.least() < before) outcome = next;
  }
  return outcome;
}

std::vector<std::string> tuning_defects(const Vector& first, const TuningGoal& goal, const Vector& scales,
                                        const BoundedMinimiser& method, const TuningOptions& options) {
  std::vector<std::string> defects;
  const auto check_size = [&](const Vector& given, const char* what) {
    if (given.size() != first.size())
      defects.push_back(std::string("tuning: ") + std::to_string(given.size()) + " " + what +
                        " were given; there are " + std::to_string(first.size()) + " numbers");
    return given.size() == first.size();
  };
  if (first.size() == 0) defects.emplace_back("tuning: the equilibrium has no parameter");
  if (check_size(options.low, "lower bounds") && check_size(options.high, "upper bounds"))
    for (Eigen::Index j = 0; j < first.size(); ++j) {
      const std::string which = "tuning: the bounds of number " + std::to_string(j);
      if (!std::isfinite(options.low[j]) || !std::isfinite(options.high[j]))
        defects.push_back(which + " are not finite");
      else if (options.low[j] > options.high[j])
        defects.push_back(which + " are reversed");
      else if (first[j] < options.low[j] || first[j] > options.high[j])
        defects.push_back(which + " do not hold its first value");
    }
  if (check_size(scales, "scales") && !((scales.array() > 0).all() && scales.allFinite()))
    defects.emplace_back("tuning: scales must be positive");
  const auto is_weight = [](double weight) { return weight >= 0 && std::isfinite(weight); };
  if (goal.change_weights.size() > 0 && check_size(goal.change_weights, "weights of changes"))
    for (const double weight : goal.change_weights)
      if (!is_weight(weight)) {
        defects.emplace_back("tuning: weights of changes must not be negative");
        break;
      }
  bool wants_something = goal.residuals != nullptr && goal.residual_weight > 0;
  if (!is_weight(goal.residual_weight))
    defects.emplace_back("tuning: the weight of the residuals must not be negative");
  for (const WeightedMetric& each : goal.metrics) {
    wants_something = wants_something || each.weight > 0;
    if (!is_weight(each.weight))
      defects.push_back("tuning: the weight of \"" + each.metric->name() + "\" must not be negative");
  }
  if (!wants_something)
    defects.emplace_back("tuning: there is nothing to minimise; give residuals or metrics a weight");
  if (method.needs_residuals() && (goal.residuals == nullptr || !goal.metrics.empty()))
    defects.push_back("tuning: the method \"" + std::string(method.name()) +
                      "\" fits residuals alone; metrics need one that takes any function");
  if (options.max_solves < 1 || !(options.max_seconds > 0))
    defects.emplace_back("tuning: the limits of solves and of time must be above 0");
  if (!(options.stop.step > 0 && std::isfinite(options.stop.step)) || !(options.stop.gain >= 0))
    defects.emplace_back("tuning: the least step must be above 0 and the least gain not negative");
  return defects;
}

}  // namespace

std::string_view tuning_status_name(TuningStatus status) {
  switch (status) {
    case TuningStatus::Converged:
      return "converged";
    case TuningStatus::Stalled:
      return "stalled";
    case TuningStatus::SolveLimit:
      return "solve_limit";
    case TuningStatus::TimeLimit:
      return "time_limit";
    case TuningStatus::Cancelled:
      return "cancelled";
    case TuningStatus::NoStart:
      return "no_start";
  }
  return "";
}

Tuning tune(const EquilibriumMaker& make, const Vector& q, const TuningGoal& goal, BoundedMinimiser& method,
            const TuningOptions& options) {
  Tuning found;
  found.start = make(q)->value();
  TuningOptions own = options;
  if (own.scales.size() == 0) own.scales = Vector::Ones(found.start.size());
  if (std::vector<std::string> defects = tuning_defects(found.start, goal, own.scales, method, own);
      !defects.empty())
    throw InputError(std::move(defects));

  TuningTrials trials(make, q, goal, own, found.start);
  const bool has_start = trials.begin();
  BoundedOutcome outcome;
  if (has_start) outcome = minimise(trials, method, own);
  found.best = trials.record();
  found.solves = static_cast<int>(found.best.history.size());
  for (const TuningTrial& trial : found.best.history) {
    if (trial.status != Status::Converged) ++found.failed;
    if (trial.lost_branch) ++found.lost_branches;
  }
  found.seconds = found.best.seconds;
  if (!has_start) {
    found.message = trials.failure();
    return found;
  }
  found.cost_before = found.best.history.front().cost;
  found.cost_after = trials.least();
  found.jacobian = trials.best_jacobian(found.residuals);
  found.anchor = trials.check_anchor();
  found.seconds = trials.seconds();
  if (trials.end()) {
    found.status = *trials.end();
    found.message = found.status == TuningStatus::Cancelled   ? "cancelled"
                    : found.status == TuningStatus::TimeLimit ? "the time is over"
                                                              : "the limit of solves is reached";
  } else {
    found.status = outcome.has_converged ? TuningStatus::Converged : TuningStatus::Stalled;
    found.message = outcome.message;
  }
  return found;
}

}  // namespace coapt
