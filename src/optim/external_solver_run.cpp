#include "optim/external_solver_run.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kWorthAnAttempt = 0.5;  // an attempt has to halve the gradient to count as a gain
constexpr int kMaxWithoutGain = 3;       // attempts in a row
constexpr int kMaxRefused = 200;         // a library that cannot find back to finite energies is stopped

double positive_or_one(double value) { return value > 0 ? value : 1; }

}  // namespace

ExternalSolverRun::ExternalSolverRun(Monitor& monitor, const Vector& q) : monitor_(monitor) {
  last_.q = accepted_.q = q;
  last_.energy = monitor_.gradient(last_.q, last_.g);
  report();
}

bool ExternalSolverRun::begin_attempt() {
  if (status_) return false;
  const double gradient = accepted_.g.norm();
  attempts_without_gain_ = gradient < kWorthAnAttempt * gradient_at_attempt_ ? 0 : attempts_without_gain_ + 1;
  if (attempts_without_gain_ > kMaxWithoutGain) return false;
  const Vector& q = accepted_.q;
  const double extent = q.maxCoeff() - q.minCoeff();
  length_ = positive_or_one(attempts_ == 0 ? 0.01 * extent : std::min(last_step_, extent));
  energy_ = positive_or_one(length_ * accepted_.g.lpNorm<Eigen::Infinity>());
  origin_ = accepted_;
  gradient_at_attempt_ = gradient;
  last_z_.resize(0);
  refused_ = 0;
  ++attempts_;
  return true;
}

double ExternalSolverRun::evaluate(const Vector& z, Vector& gradient) {
  if (!status_ && monitor_.is_out_of_time()) status_ = Status::TimeLimit;
  if (status_ || !z.allFinite() || !evaluate_last(z)) {
    gradient.setZero(z.size());
    if (++refused_ > kMaxRefused && !status_) status_ = Status::LineSearchFailed;
    return kInfinity;
  }
  refused_ = 0;
  gradient = last_.g * (length_ / energy_);
  const double change =
      attempts_ > 1 ? 0.5 * (last_.g + origin_.g).dot(last_.q - origin_.q) : last_.energy - origin_.energy;
  return change / energy_;
}

bool ExternalSolverRun::accept(const Vector& z) {
  if (status_) return false;
  const bool is_known = z.size() == last_z_.size() && z == last_z_;
  if (is_known || evaluate_last(z)) {
    if (last_.q != accepted_.q) report();
  }
  return !status_;
}

bool ExternalSolverRun::accept_if_better() {
  if (status_) return false;
  const double change = last_.energy - accepted_.energy;
  const double noise = monitor_.energy_noise(accepted_.energy);
  if (change < -noise || (change <= noise && last_.g.norm() < accepted_.g.norm())) report();
  return !status_;
}

bool ExternalSolverRun::evaluate_last(const Vector& z) {
  last_z_ = z;
  last_.q = origin_.q + length_ * z;
  last_.energy = monitor_.gradient(last_.q, last_.g);
  return std::isfinite(last_.energy) && last_.g.allFinite();
}

void ExternalSolverRun::report() {
  status_ = monitor_.accept(last_.q, last_.energy, last_.g);
  if (status_ == Status::NonFinite) return;
  last_step_ = (last_.q - accepted_.q).lpNorm<Eigen::Infinity>();
  accepted_ = last_;
}

}  // namespace coapt
