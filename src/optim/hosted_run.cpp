#include "optim/hosted_run.hpp"

#include <cmath>

namespace coapt {
namespace {

constexpr double kWorthAnAttempt = 0.5;  // an attempt has to halve the gradient to earn another
constexpr int kMaxRefused = 200;         // a library that cannot find back to finite energies is stopped

}  // namespace

HostedRun::HostedRun(Monitor& monitor, const Vector& q) : monitor_(monitor) {
  last_.q = q;
  last_.energy = monitor_.gradient(last_.q, last_.g);
  accepted_.q = q;
  report(last_);
}

double HostedRun::evaluate(const Vector& q, Vector& g) {
  if (!status_ && monitor_.is_out_of_time()) status_ = Status::TimeLimit;
  if (status_ || !q.allFinite()) {
    g.setZero(q.size());
    if (++refused_ > kMaxRefused && !status_) status_ = Status::LineSearchFailed;
    return kInfinity;
  }
  last_.q = q;
  last_.energy = monitor_.gradient(last_.q, last_.g);
  if (!std::isfinite(last_.energy) || !last_.g.allFinite()) {
    last_.energy = kInfinity;
    g.setZero(q.size());
    if (++refused_ > kMaxRefused) status_ = Status::LineSearchFailed;
    return kInfinity;
  }
  refused_ = 0;
  g = last_.g;
  return base_ ? 0.5 * (last_.g + base_->g).dot(last_.q - base_->q) : last_.energy;
}

bool HostedRun::accept(const Vector& q) {
  if (status_) return false;
  if (q == accepted_.q) return true;
  if (q != last_.q) {
    last_.q = q;
    last_.energy = monitor_.gradient(last_.q, last_.g);
  }
  report(last_);
  return !status_;
}

bool HostedRun::accept_if_better() {
  if (status_) return false;
  const double change = last_.energy - accepted_.energy;
  const double noise = monitor_.energy_noise(accepted_.energy);
  if (change < -noise || (change <= noise && last_.g.norm() < accepted_.g.norm())) report(last_);
  return !status_;
}

bool HostedRun::begin_attempt() {
  const double gradient = accepted_.g.norm();
  if (status_ || (attempts_ > 1 && !(gradient < kWorthAnAttempt * gradient_at_attempt_))) return false;
  if (attempts_ > 0) base_ = accepted_;
  ++attempts_;
  gradient_at_attempt_ = gradient;
  refused_ = 0;
  return true;
}

void HostedRun::report(const Evaluation& evaluation) {
  status_ = monitor_.accept(evaluation.q, evaluation.energy, evaluation.g);
  if (status_ != Status::NonFinite) accepted_ = evaluation;
}

}  // namespace coapt
