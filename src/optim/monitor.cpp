#include "optim/monitor.hpp"

namespace coapt {

Monitor::Monitor(Objective& objective, const StopRule& stop, const Observer& observer)
    : objective_(objective),
      stop_(stop),
      observer_(observer),
      tolerance_(stop.tolerance),
      start_(wall_seconds()) {}

double Monitor::value(const Vector& q) {
  PhaseTimer timer(phases_, "value");
  return objective_.value(q);
}

double Monitor::gradient(const Vector& q, Vector& g) {
  PhaseTimer timer(phases_, "gradient");
  return objective_.gradient(q, g);
}

double Monitor::hessian(const Vector& q, Vector& g, Eigen::SparseMatrix<double>& h, Projection projection) {
  PhaseTimer timer(phases_, "hessian");
  return objective_.hessian(q, g, h, projection);
}

bool Monitor::is_out_of_time() const { return seconds() >= stop_.max_seconds; }

void Monitor::begin_round(int round, double tolerance) {
  round_ = round;
  tolerance_ = tolerance;
  is_first_of_round_ = true;
}

std::optional<Status> Monitor::accept(const Vector& q, double energy, const Vector& g) {
  if (!std::isfinite(energy) || !g.allFinite()) return Status::NonFinite;
  if (!is_first_of_round_) ++iterations_;
  is_first_of_round_ = false;

  Iteration now;
  now.iteration = iterations_;
  now.round = round_;
  now.energy = energy;
  now.residual = objective_.relative_residual(g);
  now.step = last_.size() == q.size() && q.size() > 0 ? (q - last_).lpNorm<Eigen::Infinity>() : 0;
  now.seconds = seconds();
  now.evaluations = objective_.counts().gradient + objective_.counts().hessian;
  last_ = q;
  objective_.advance(q);
  trace_.push_back(now);

  if (observer_ && !observer_(now, q)) {
    cancelled_ = true;
    return Status::Cancelled;
  }
  if (now.residual <= tolerance_) return Status::Converged;
  if (is_out_of_time()) return Status::TimeLimit;
  if (iterations_ >= stop_.max_iterations) return Status::IterationLimit;
  return std::nullopt;
}

}  // namespace coapt
