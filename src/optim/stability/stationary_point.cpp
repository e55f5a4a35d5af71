#include "optim/stability/stationary_point.hpp"

#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr int kMostSteps = 20;      // of Newton's method for the forces
constexpr int kStepHalvings = 4;    // of a step that does not lessen the forces
constexpr double kLeastFall = 0.1;  // of the norm of the forces, relative to what a linear model promises

// Without pivoting for size: where a leading minor vanishes the step is no good, and the line search says so.
bool newton_step(const SparseMatrix& lower, const Vector& g, Vector& step) {
  const Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower> factor(lower);
  if (factor.info() != Eigen::Success) return false;
  step = -factor.solve(g);
  return step.allFinite();
}

// Goes along the step as far as the forces become smaller.
bool take_step(Monitor& monitor, const Vector& step, double before, Vector& q) {
  Vector g;
  double length = monitor.step_limit(q, step, 1);
  for (int halving = 0; halving < kStepHalvings; ++halving, length *= 0.5) {
    const Vector trial = q + length * step;
    monitor.gradient(trial, g);
    if (!(g.norm() < (1 - kLeastFall * length) * before)) continue;
    q = trial;
    return true;
  }
  return false;
}

}  // namespace

StationarySearch reach_stationary_point(Objective& objective, Vector& q, Monitor& monitor, double tolerance) {
  StationarySearch search;
  if (objective.has_circulatory_force()) return search;
  monitor.begin_outer_iteration(monitor.outer_iteration() + 1, tolerance, false);
  Vector g, step;
  SparseMatrix h;
  for (int k = 0;; ++k) {
    const double energy = monitor.hessian(q, g, h, Projection::None);
    if (!g.allFinite()) break;
    search.least_residual = std::min(search.least_residual, objective.relative_residual(q, g));
    const std::optional<Status> end = monitor.accept(q, energy, g);
    search.is_found = end == Status::Converged;
    if (end || k == kMostSteps || !newton_step(h, g, step)) break;
    monitor.count_factorisation();
    if (!take_step(monitor, step, g.norm(), q)) break;
  }
  return search;
}

}  // namespace coapt
