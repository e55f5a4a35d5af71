#include "optim/quasi_newton.hpp"

#include "optim/line_search.hpp"

#include <algorithm>

namespace coapt {
namespace {

Vector descent_direction(InverseHessian& inverse, LinePoint& at, Monitor& monitor) {
  PhaseTimer timer(monitor.phases(), "direction");
  Vector direction = inverse.direction(at.g);
  at.slope = at.g.dot(direction);
  if (!(at.slope < 0)) {  // round-off has eaten the positive curvature
    inverse.clear();
    direction = -at.g;
    at.slope = -at.g.squaredNorm();
  }
  return direction;
}

// Without curvature the length of the step is a guess: 1 % of the size of the unknowns.
double first_step(const InverseHessian& inverse, const Vector& q, const Vector& direction) {
  if (!inverse.is_empty()) return 1;
  const double spread = std::max(q.maxCoeff() - q.minCoeff(), 1e-12);
  return std::min(1.0, 0.01 * spread / direction.lpNorm<Eigen::Infinity>());
}

}  // namespace

Status descend(InverseHessian& inverse, Vector& q, Monitor& monitor) {
  LinePoint at, next;
  at.q = q;
  at.energy = monitor.gradient(at.q, at.g);
  while (true) {
    if (const auto status = monitor.accept(at.q, at.energy, at.g)) return *status;
    inverse.visit(at.q);
    bool is_found = false;
    while (!is_found) {
      const Vector direction = descent_direction(inverse, at, monitor);
      is_found = search_line(monitor, at, direction, first_step(inverse, at.q, direction), next);
      if (is_found) break;
      if (monitor.is_out_of_time()) return Status::TimeLimit;
      if (inverse.is_empty()) return Status::LineSearchFailed;
      inverse.clear();  // start afresh from steepest descent before giving up
    }
    {
      PhaseTimer timer(monitor.phases(), "direction");
      inverse.learn(next.q - at.q, next.g - at.g);
    }
    std::swap(at, next);
    q = at.q;
  }
}

}  // namespace coapt
