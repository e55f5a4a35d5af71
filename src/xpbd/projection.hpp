// Gauss-Seidel sweeps over constraints, colour by colour (Macklin et al. 2016, eq. 17-18):
//   d(lambda) = -k (C + alpha/dt^2 lambda) / (sum_a w_a |grad_a C|^2 + alpha/dt^2),   x_a += w_a grad_a C
//   d(lambda)
// lambda is summed over the sweeps of a step and kept within the constraint's sense, so that a constraint
// that is slack corrects nothing at all.
#pragma once

#include "core/thread_team.hpp"
#include "xpbd/colouring.hpp"
#include "xpbd/constraints.hpp"

#include <algorithm>
#include <vector>

namespace coapt {

// Inverse masses by coordinate, 3 x node_count; zero where a coordinate is prescribed. [1/mass]
using InverseMasses = Points;

inline double admissible(double lambda, ConstraintSense sense) {
  if (sense == ConstraintSense::PullsOnly) return std::min(lambda, 0.0);
  if (sense == ConstraintSense::PushesOnly) return std::max(lambda, 0.0);
  return lambda;
}

// Corrects x and lambda by one constraint of this value.
template <int N>
void correct(const ConstraintValue<N>& c, const std::array<int, N>& nodes, double compliance,
             double stiffness, ConstraintSense sense, double dt2, const InverseMasses& w, Points& x,
             double& lambda) {
  double mobility = 0;
  for (size_t a = 0; a < N; ++a) mobility += w.col(nodes[a]).dot(c.gradient[a].cwiseAbs2());
  if (!(mobility > 0)) return;
  const double alpha = compliance / dt2;
  const double wanted = lambda - stiffness * (c.value + alpha * lambda) / (mobility + alpha);
  const double change = admissible(wanted, sense) - lambda;
  if (change == 0) return;
  lambda += change;
  for (size_t a = 0; a < N; ++a) x.col(nodes[a]) += change * w.col(nodes[a]).cwiseProduct(c.gradient[a]);
}

template <class K>
void project(const K& constraint, double dt2, const InverseMasses& w, Points& x, double& lambda) {
  const ConstraintValue<K::kNodes> c = constraint.at(x);
  correct<K::kNodes>(c, constraint.nodes, constraint.compliance(c.value), constraint.stiffness,
                     constraint.sense, dt2, w, x, lambda);
}

// By the tangent of the law; without slope (a constant tension) by its limit.
inline void project(LineConstraint& line, double dt2, const InverseMasses& w, Points& x, double& lambda) {
  const Vec3 d = x.col(line.nodes[1]) - x.col(line.nodes[0]);
  const double l = d.norm();
  if (!(l > 0)) return;
  AxialLaw law = line.law(l);
  const bool is_slack = line.sense == ConstraintSense::PullsOnly && law.force <= 0;
  if (is_slack) {
    law.force = line.slope * std::min(l - line.length, 0.0);
    law.stiffness = line.slope;
  } else {
    line.slope = law.stiffness = std::max(law.stiffness, 0.0);
  }
  const Vec3 n = d / l, squares = n.cwiseAbs2();
  const double mobility = (w.col(line.nodes[0]) + w.col(line.nodes[1])).dot(squares);
  if (!(mobility > 0)) return;
  const double wanted = lambda - (law.force * dt2 + lambda) / (1 + law.stiffness * dt2 * mobility);
  const double change = admissible(wanted, line.sense) - lambda;
  if (change == 0) return;
  lambda += change;
  x.col(line.nodes[0]) -= change * w.col(line.nodes[0]).cwiseProduct(n);
  x.col(line.nodes[1]) += change * w.col(line.nodes[1]).cwiseProduct(n);
}

// The constraints of one kind, class after class, and their multipliers.
template <class K>
class ColouredConstraints {
 public:
  ColouredConstraints() = default;
  ColouredConstraints(const std::vector<K>& all, int node_count) {
    std::vector<int> nodes;
    nodes.reserve(all.size() * K::kNodes);
    for (const K& one : all) nodes.insert(nodes.end(), one.nodes.begin(), one.nodes.end());
    const ColourClasses classes = colour_classes(nodes, K::kNodes, node_count);
    first_ = classes.first;
    constraints_.reserve(all.size());
    for (const int e : classes.order) constraints_.push_back(all[static_cast<size_t>(e)]);
    lambda_.assign(all.size(), 0);
  }

  size_t size() const { return constraints_.size(); }
  const std::vector<K>& all() const { return constraints_; }
  const std::vector<double>& multipliers() const { return lambda_; }

  void begin_step() { std::fill(lambda_.begin(), lambda_.end(), 0.0); }

  // One projection of each. team: may share a class.
  void sweep(double dt2, const InverseMasses& w, Points& x, ThreadTeam& team) {
    for (size_t c = 0; c + 1 < first_.size(); ++c) {
      const auto from = static_cast<size_t>(first_[c]), count = static_cast<size_t>(first_[c + 1]) - from;
      team.run_ranges(count, kWorthThreads, [&](size_t low, size_t high) {
        for (size_t e = from + low; e < from + high; ++e) project(constraints_[e], dt2, w, x, lambda_[e]);
      });
    }
  }

 private:
  static constexpr size_t kWorthThreads = 512;  // constraints that are worth waking a thread

  std::vector<K> constraints_;
  std::vector<int> first_;
  std::vector<double> lambda_;
};

}  // namespace coapt
