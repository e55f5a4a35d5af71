#include "sensitivity/detail/tuning_trials.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"

#include <cmath>

namespace coapt {

TuningTrials::TuningTrials(const EquilibriumMaker& make, const Vector& q, const TuningGoal& goal,
                           const TuningOptions& options, const Vector& first)
    : make_(make),

      goal_(goal),
      options_(options),
      first_(scaled(first)),
      low_(scaled(options.low)),
      high_(scaled(options.high)),
      change_weights_(goal.change_weights.size() > 0 ? goal.change_weights : Vector::Zero(first.size())),
      begin_s_(wall_seconds()) {
  best_.value = first;
  best_.q = q;
  if (options.known == nullptr) return;
  best_ = *options.known;
  seconds_before_ = best_.seconds;
}

double TuningTrials::seconds() const { return seconds_before_ + wall_seconds() - begin_s_; }

bool TuningTrials::begin() {
  if (best_.history.empty()) {
    equilibrium_ = make_(best_.q);
    if (!solve(first())) return false;
  } else {
    for (const TuningTrial& trial : best_.history) least_ = std::min(least_, trial.cost);
    if (!take_up_best()) {
      failure_ = "the shape of the best trial so far did not converge: " + failure_;
      return false;
    }
  }
  anchor_value_ = best_.value;
  anchor_q_ = best_.q;
  if (options_.start) take_up_start();
  return true;
}

std::optional<AnchorCheck> TuningTrials::check_anchor() {
  if (end_ == TuningStatus::Cancelled || best_.value == anchor_value_) return std::nullopt;
  if (!(is_at_best_ && is_current_) && !take_up_best()) return std::nullopt;
  equilibrium_->anchor_at(anchor_value_, anchor_q_);
  return equilibrium_->check_anchor();
}

// Where it is no better, or does not converge, the search begins at the first numbers.
void TuningTrials::take_up_start() {
  if (has_ended()) return;
  const TuningStart start = options_.start(best_);
  best_.history.insert(best_.history.end(), start.trials.begin(), start.trials.end());
  if (start.value.size() == 0 || has_ended()) return;
  equilibrium_.reset();
  equilibrium_ = make_(start.q);
  attempt(scaled(start.value));
}

// A new equilibrium at the best shape: where a trial ended tells nothing of where the next should start.
bool TuningTrials::take_up_best() {
  equilibrium_.reset();
  equilibrium_ = make_(best_.q);
  equilibrium_->set(best_.value);
  const WarmSolve solved = equilibrium_->solve();
  is_at_best_ = solved.status == Status::Converged;
  is_current_ = is_at_best_;
  if (!is_at_best_) {
    failure_ = solved.message;
    return false;
  }
  TuningTrial again;
  measure(again);
  z_ = scaled(best_.value);
  cost_ = again.cost;
  return true;
}

void TuningTrials::measure(TuningTrial& trial) {
  const Points x = equilibrium_->positions();
  trial.cost = change_weights_.dot((scaled(equilibrium_->value()) - first_).cwiseAbs2());
  if (goal_.residuals != nullptr) {
    r_ = goal_.residuals->values(x);
    trial.misfit = r_.squaredNorm();
    trial.cost += goal_.residual_weight * trial.misfit;
  }
  for (const WeightedMetric& each : goal_.metrics) {
    trial.metrics.push_back(each.metric->evaluate(x, nullptr));
    trial.cost += each.weight * trial.metrics.back();
  }
}

bool TuningTrials::solve(const Vector& z) {
  if (z_.size() == z.size() && z_ == z && is_current_) return true;
  if (z_.size() == z.size() && z_ == z && !best_.history.empty() && !std::isfinite(cost_)) return false;
  if (has_ended()) return false;
  if (!best_.history.empty() && !is_at_best_ && !take_up_best()) return false;
  return attempt(z);
}

bool TuningTrials::has_ended() {
  if (end_) return true;
  if (options_.is_cancelled && options_.is_cancelled())
    end_ = TuningStatus::Cancelled;
  else if (std::ssize(best_.history) >= options_.max_solves)
    end_ = TuningStatus::SolveLimit;
  else if (wall_seconds() - begin_s_ >= options_.max_seconds)
    end_ = TuningStatus::TimeLimit;
  return end_.has_value();
}

// From where the equilibrium is.
bool TuningTrials::attempt(const Vector& z) {
  TuningTrial trial;
  trial.value = z.cwiseQuotient(options_.scales);
  equilibrium_->set(trial.value);
  const WarmSolve solved = equilibrium_->solve();
  trial.status = solved.status;
  trial.iterations = solved.iterations;
  trial.lost_branch = solved.lost_branch;
  if (solved.status == Status::Converged)
    measure(trial);
  else
    failure_ = solved.message;
  if (!std::isfinite(trial.cost)) trial.cost = kInfinity;
  z_ = z;
  cost_ = trial.cost;
  is_current_ = std::isfinite(cost_);
  trial.is_best = cost_ < least_;
  is_at_best_ = trial.is_best;
  if (trial.is_best) {
    least_ = cost_;
    best_.value = trial.value;
    best_.q = equilibrium_->unknowns();
  }
  trial.seconds = best_.seconds = seconds();
  best_.history.push_back(std::move(trial));
  if (options_.report) options_.report(best_.history.back());
  if (options_.keep) options_.keep(best_);
  return is_current_;
}

double TuningTrials::value(const Vector& z, Vector* gradient) {
  if (!solve(z) || (gradient != nullptr && !this->gradient(*gradient))) return kInfinity;
  return cost_;
}

// One adjoint system for the whole cost.
bool TuningTrials::gradient(Vector& gradient) {
  const Points x = equilibrium_->positions();
  Points by_x = Points::Zero(3, x.cols()), by_metric(3, x.cols());
  if (goal_.residuals != nullptr) by_x = 2 * goal_.residual_weight * goal_.residuals->pull_back(x, r_);
  for (const WeightedMetric& each : goal_.metrics) {
    each.metric->evaluate(x, &by_metric);
    by_x += each.weight * by_metric;
  }
  try {
    gradient = equilibrium_->pull_back(by_x);
  } catch (const InputError& error) {
    failure_ = error.what();
    return false;
  }
  for (size_t k = 0; k < equilibrium_->parameter_count(); ++k)
    for (const WeightedMetric& each : goal_.metrics) {
      const Vector direct = each.metric->partial(equilibrium_->parameter(k), x);
      gradient.segment(equilibrium_->first_number(k), direct.size()) += each.weight * direct;
    }
  gradient = gradient.cwiseQuotient(options_.scales);
  gradient += 2 * change_weights_.cwiseProduct(scaled(equilibrium_->value()) - first_);
  return gradient.allFinite();
}

// One forward system for each number: there are fewer of them than residuals.
bool TuningTrials::jacobian(Eigen::MatrixXd& rows) {
  if (z_of_jacobian_.size() == z_.size() && z_of_jacobian_ == z_) {
    rows = jacobian_;
    return true;
  }
  std::vector<Points> motions;
  try {
    for (Eigen::Index j = 0; j < z_.size(); ++j) {
      if (options_.is_cancelled && options_.is_cancelled()) {
        end_ = TuningStatus::Cancelled;
        return false;
      }
      Vector change = Vector::Zero(z_.size());
      change[j] = 1 / options_.scales[j];
      motions.push_back(equilibrium_->response(change));
    }
  } catch (const InputError& error) {
    failure_ = error.what();
    return false;
  }
  rows = goal_.residuals->derivatives(equilibrium_->positions(), motions);
  jacobian_ = rows;
  z_of_jacobian_ = z_;
  r_of_jacobian_ = r_;
  return rows.allFinite();
}

bool TuningTrials::residuals(const Vector& z, Vector& r, Eigen::MatrixXd* jacobian) {
  if (!solve(z)) return false;
  const Eigen::Index own = r_.size(), count = z.size();
  const double root = std::sqrt(goal_.residual_weight);
  const Vector change_roots = change_weights_.cwiseSqrt();
  r.resize(own + count);
  r << root * r_, change_roots.cwiseProduct(z - first_);
  if (jacobian == nullptr) return true;
  Eigen::MatrixXd rows;
  if (!this->jacobian(rows)) return false;
  jacobian->resize(own + count, count);
  jacobian->topRows(own) = root * rows;
  jacobian->bottomRows(count) = change_roots.asDiagonal();
  return true;
}

Eigen::MatrixXd TuningTrials::best_jacobian(Vector& residuals) {
  Eigen::MatrixXd rows;
  if (goal_.residuals == nullptr) return rows;
  const Vector z = scaled(best_.value);
  const bool is_known = z_of_jacobian_.size() == z.size() &&
                        (z_of_jacobian_ - z).cwiseAbs().maxCoeff() <= 1e-12 * z.cwiseAbs().maxCoeff();
  if (is_known) rows = jacobian_;
  if (!is_known && end_ != TuningStatus::Cancelled && ((is_at_best_ && is_current_) || take_up_best()))
    if (!jacobian(rows)) rows.resize(0, 0);
  if (rows.size() > 0) residuals = r_of_jacobian_;
  return rows;
}

}  // namespace coapt
