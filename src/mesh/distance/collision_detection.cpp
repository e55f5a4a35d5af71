#include "mesh/distance/collision_detection.hpp"

#include "mesh/distance/triangle_distance.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

// Rounding of the coordinates and of all that is computed from them, as a share of their norm: thrice the
// bound.
constexpr double kRoundOff = 4e-15;
// The search ends when the sides move less than this share of the distance to keep, or after so many
// advances: what is reached by then is safe, only shorter than need be.
constexpr double kLittleProgress = 0.01;
constexpr int kMostAdvances = 1000;
// Lengths whose squares neither vanish nor overflow.
constexpr double kSmallest = 1e-140, kLargest = 1e140;

// Corners [0, kFirst) against the others.
struct PointTriangle {
  static constexpr int kFirst = 1;
  static Vec3 nearest(const PairCorners& x) {  // from the second side to the first
    return x.col(0) - closest_on_triangle(x.col(0), x.col(1), x.col(2), x.col(3)).point;
  }
  static Vec3 normal(const PairCorners& x) {
    return Vec3(x.col(2) - x.col(1)).cross(Vec3(x.col(3) - x.col(1)));
  }
};

struct EdgeEdge {
  static constexpr int kFirst = 2;
  static Vec3 nearest(const PairCorners& x) {
    const ClosestOnSegments closest = closest_on_segments(x.col(0), x.col(1), x.col(2), x.col(3));
    return closest.first - closest.second;
  }
  static Vec3 normal(const PairCorners& x) {
    return Vec3(x.col(1) - x.col(0)).cross(Vec3(x.col(3) - x.col(2)));
  }
};

// The least distance of a corner of the first side from one of the second, by their heights in some
// direction.
template <class Pair>
double gap(const Eigen::RowVector4d& heights) {
  return heights.template head<Pair::kFirst>().minCoeff() -
         heights.template tail<4 - Pair::kFirst>().maxCoeff();
}

// Whether the plane across the line between the closest points does for the whole step. Most pairs need no
// more than this, so it takes one root and no division.
template <class Pair>
bool is_free(const PairCorners& x, const PairCorners& d, double most, double kept) {
  const Vec3 between = Pair::nearest(x);
  const double distance_squared = between.squaredNorm();
  if (!(distance_squared > kSmallest)) return false;  // products of squares below would vanish
  const double size_squared = 2 * (x.squaredNorm() + most * most * d.squaredNorm());
  const double least = kept * distance_squared + kRoundOff * std::sqrt(size_squared * distance_squared);
  const Eigen::RowVector4d now = between.transpose() * x, end = now + most * (between.transpose() * d);
  return gap<Pair>(now) > least && gap<Pair>(end) > least;
}

struct Advance {
  double gap;   // the least distance of a corner of the first side from one of the second along the direction
  double step;  // up to which they stay apart, at most the one asked for; 0 where they are not even now
};

// How long all corners of the first side stay further than `distance + step * rate` from those of the second,
// along the unit vector n.
template <class Pair>
Advance advance(const PairCorners& x, const PairCorners& d, const Vec3& n, double distance, double rate,
                double most) {
  const Eigen::RowVector4d height = n.transpose() * x, speed = n.transpose() * d;
  Advance found{kInfinity, most};
  for (int i = 0; i < Pair::kFirst; ++i)
    for (int j = Pair::kFirst; j < 4; ++j) {
      const double gap = height[i] - height[j], slack = gap - distance, closing = speed[j] - speed[i] + rate;
      found.gap = std::min(found.gap, gap);
      if (closing * found.step > slack) found.step = slack / closing;
    }
  if (found.gap <= distance) found.step = 0;
  return found;
}

template <class Pair>
double safe_step(const PairCorners& x, const PairCorners& d, double most, double kept) {
  if (is_free<Pair>(x, d, most, kept)) return most;
  // Bounds of the coordinates; not finite where one of them is not.
  const double size = x.norm(), size_rate = d.norm();
  if (!(size + most * size_rate < kLargest)) return 0;
  // Seen from one of the corners, so that what is computed loses no digits far from the origin.
  const PairCorners start = x.colwise() - x.col(3), move = d.colwise() - d.col(3);

  PairCorners now = start;
  Vec3 between = Pair::nearest(now);
  double distance = between.norm(), step = 0;
  if (!(distance > kSmallest)) return 0;
  const double to_keep = kept * distance;
  for (int k = 0; k < kMostAdvances; ++k) {
    const double least = to_keep + kRoundOff * (size + step * size_rate), rate = kRoundOff * size_rate;
    const auto along = [&](const Vec3& n) { return advance<Pair>(now, move, n, least, rate, most - step); };
    Advance found = along(between / distance);
    if (found.gap < 0.9 * distance) {  // so near that rounding has turned the direction
      const Vec3 normal = Pair::normal(now).stableNormalized();
      const Advance other = along(normal.dot(between) < 0 ? Vec3(-normal) : normal);
      if (other.gap > found.gap) found = other;
    }
    if (found.step >= most - step) return most;
    step += found.step;
    if (2 * move.norm() * found.step <= kLittleProgress * least) break;
    now = start + step * move;
    between = Pair::nearest(now);
    distance = between.norm();
    if (!(distance > kSmallest)) break;
  }
  return step;
}

}  // namespace

double point_triangle_step(const PairCorners& x, const PairCorners& d, double most, double kept) {
  return safe_step<PointTriangle>(x, d, most, kept);
}

double edge_edge_step(const PairCorners& x, const PairCorners& d, double most, double kept) {
  return safe_step<EdgeEdge>(x, d, most, kept);
}

}  // namespace coapt
