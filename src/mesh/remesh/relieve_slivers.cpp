#include "mesh/remesh/relieve_slivers.hpp"

#include "mesh/remesh/prolong.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace coapt {
namespace {

constexpr int kMostRounds = 10;  // through the triangles that are distorted too much
constexpr double kGain = 0.9;    // of the worst distortion around a vertex that moves

// From the metric of the motion in the plane of the triangle at rest.
Distortion distortion(const Points& X, const Points& x, const Eigen::Vector3i& t) {
  const Vec3 A = X.col(t[1]) - X.col(t[0]), B = X.col(t[2]) - X.col(t[0]);
  const Vec3 a = x.col(t[1]) - x.col(t[0]), b = x.col(t[2]) - x.col(t[0]);
  const double length = A.norm(), along = length > 0 ? B.dot(A) / length : 0;
  const double height = length > 0 ? (B - along / length * A).norm() : 0;
  if (!(height > 0)) return {};
  const Vec3 first = a / length, second = (b - along * first) / height;
  const double p = first.squaredNorm(), q = second.squaredNorm(), r = first.dot(second);
  const double mean = 0.5 * (p + q), apart = std::hypot(0.5 * (p - q), r), greatest = mean + apart;
  const double least =
      first.cross(second).squaredNorm() / greatest;  // their product is the squared area ratio
  return {std::sqrt(greatest), least > 0 ? 1 / std::sqrt(least) : std::numeric_limits<double>::infinity()};
}

std::vector<std::vector<int>> triangles_around(const Triangles& triangles, Eigen::Index vertices) {
  std::vector<std::vector<int>> around(static_cast<size_t>(vertices));
  for (int t = 0; t < triangles.cols(); ++t)
    for (const int v : triangles.col(t)) around[static_cast<size_t>(v)].push_back(t);
  return around;
}

class Relief {
 public:
  Relief(const Triangles& triangles, const Points& X, const std::vector<char>& may_move,
         const Distortion& most, Points& x)
      : triangles_(triangles),
        X_(X),
        may_move_(may_move),
        most_(most),
        x_(x),
        excess_(triangles.cols()),
        around_(triangles_around(triangles, X.cols())) {
    for (int t = 0; t < excess_.size(); ++t) excess_[t] = excess(t);
  }

  // Whether any vertex moved.
  bool round() {
    std::vector<int> worst;
    for (int t = 0; t < excess_.size(); ++t)
      if (excess_[t] > 1) worst.push_back(t);
    std::stable_sort(worst.begin(), worst.end(), [&](int s, int t) { return excess_[s] > excess_[t]; });
    bool has_moved = false;
    for (const int t : worst)
      if (excess_[t] > 1) has_moved = relieve(t) || has_moved;
    return has_moved;
  }

 private:
  // Distortion of a triangle over the most that it may have.
  double excess(int t) const {
    const Distortion found = distortion(X_, x_, triangles_.col(t));
    return std::max(found.stretch / most_.stretch, found.shrinkage / most_.shrinkage);
  }

  double worst_around(int v) const {
    double worst = 0;
    for (const int t : around_[static_cast<size_t>(v)]) worst = std::max(worst, excess(t));
    return worst;
  }

  bool relieve(int t) {
    int best = -1;
    double least = kGain;  // of the worst around the vertex
    Vec3 place;
    for (int k = 0; k < 3; ++k) {
      const int v = triangles_(k, t), a = triangles_((k + 1) % 3, t), b = triangles_((k + 2) % 3, t);
      if (may_move_[static_cast<size_t>(v)] == 0) continue;
      const Vec3 before = x_.col(v);
      const double worst = worst_around(v);
      for (const int n : around_[static_cast<size_t>(a)]) {
        if (n == t || (triangles_.col(n).array() == b).count() == 0) continue;
        const Eigen::Vector3i beyond = triangles_.col(n);
        x_.col(v) = x_.col(a) + motion_gradient(X_, x_, beyond) * (X_.col(v) - X_.col(a));
        const double after = worst_around(v), ratio = std::isinf(worst) ? 0 : after / worst;
        if (ratio < least && std::isfinite(after)) {
          least = ratio;
          best = v;
          place = x_.col(v);
        }
        x_.col(v) = before;
      }
    }
    if (best < 0) return false;
    x_.col(best) = place;
    for (const int n : around_[static_cast<size_t>(best)]) excess_[n] = excess(n);
    return true;
  }

  const Triangles& triangles_;
  const Points& X_;
  const std::vector<char>& may_move_;
  const Distortion most_;
  Points& x_;
  Vector excess_;  // of each triangle
  std::vector<std::vector<int>> around_;
};

}  // namespace

Distortion greatest_distortion(const Triangles& triangles, const Points& X, const Points& x) {
  Distortion greatest;
  for (const auto t : triangles.colwise()) {
    const Distortion found = distortion(X, x, t);
    greatest.stretch = std::max(greatest.stretch, found.stretch);
    greatest.shrinkage = std::max(greatest.shrinkage, found.shrinkage);
  }
  return greatest;
}

void relieve_slivers(const Triangles& triangles, const Points& X, const std::vector<char>& may_move,
                     const Distortion& most, Points& x) {
  Relief relief(triangles, X, may_move, most, x);
  for (int round = 0; round < kMostRounds && relief.round(); ++round) {
  }
}

}  // namespace coapt
