#include "energy/contact/collision_detection.hpp"

#include "mesh/triangle_distance.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kRoundOff = 1e-14;       // of coordinates and all that is computed from them, with reserve
constexpr double kLittleProgress = 0.01;  // of the distance to keep
constexpr int kMostAdvances = 1000;       // what is reached by then is safe, only shorter than need be
constexpr double kSmallest = 1e-140, kLargest = 1e140;  // lengths whose squares neither vanish nor overflow

// Corners [0, kFirst) against the others.
struct PointTriangle {
  static constexpr int kFirst = 1;
  static Vec3 nearest(const Corners4& x) {  // from the second side to the first
    return x.col(0) - closest_on_triangle(x.col(0), x.col(1), x.col(2), x.col(3)).point;
  }
  static Vec3 normal(const Corners4& x) { return Vec3(x.col(2) - x.col(1)).cross(Vec3(x.col(3) - x.col(1))); }
};

struct EdgeEdge {
  static constexpr int kFirst = 2;
  static Vec3 nearest(const Corners4& x) {
    const ClosestOnSegments closest = closest_on_segments(x.col(0), x.col(1), x.col(2), x.col(3));
    return closest.first - closest.second;
  }
  static Vec3 normal(const Corners4& x) { return Vec3(x.col(1) - x.col(0)).cross(Vec3(x.col(3) - x.col(2))); }
};

// The least distance of a corner of the first side from one of the second along n.
template <class Pair>
double gap(const Corners4& x, const Vec3& n) {
  const Eigen::RowVector4d height = n.transpose() * x;
  return height.template head<Pair::kFirst>().minCoeff() -
         height.template tail<4 - Pair::kFirst>().maxCoeff();
}

// The step up to which all corners of the first side stay further than `distance + step * rate` from those of
// the second along the unit vector n; 0 where they do not even now.
template <class Pair>
double advance(const Corners4& x, const Corners4& d, const Vec3& n, double distance, double rate) {
  const Eigen::RowVector4d height = n.transpose() * x, speed = n.transpose() * d;
  double step = kInfinity;
  for (int i = 0; i < Pair::kFirst; ++i)
    for (int j = Pair::kFirst; j < 4; ++j) {
      const double slack = height[i] - height[j] - distance, closing = speed[j] - speed[i] + rate;
      if (!(slack > 0)) return 0;
      if (closing > 0) step = std::min(step, slack / closing);
    }
  return step;
}

template <class Pair>
double safe_step(const Corners4& x, const Corners4& d, double most, double kept) {
  const double size = x.cwiseAbs().maxCoeff<Eigen::PropagateNaN>(),
               size_rate = d.cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
  if (!(size + most * size_rate < kLargest)) return 0;
  // Seen from one of the corners, so that what is computed loses no digits far from the origin.
  const Corners4 start = x.colwise() - x.col(3), move = d.colwise() - d.col(3);

  Corners4 now = start;
  Vec3 between = Pair::nearest(now);
  double distance = between.norm(), step = 0;
  if (!(distance > kSmallest)) return 0;
  const double to_keep = kept * distance;
  const double fastest = 2 * move.cwiseAbs().maxCoeff();
  for (int k = 0; k < kMostAdvances; ++k) {
    Vec3 n = between / distance;
    if (gap<Pair>(now, n) < 0.9 * distance) {  // so near that rounding has turned the direction
      Vec3 other = Pair::normal(now).stableNormalized();
      if (other.dot(between) < 0) other = -other;
      if (gap<Pair>(now, other) > gap<Pair>(now, n)) n = other;
    }
    const double further =
        advance<Pair>(now, move, n, to_keep + kRoundOff * (size + step * size_rate), kRoundOff * size_rate);
    if (step + further >= most) return most;
    step += further;
    if (fastest * further <= kLittleProgress * to_keep) break;
    now = start + step * move;
    between = Pair::nearest(now);
    distance = between.norm();
    if (!(distance > kSmallest)) break;
  }
  return step;
}

}  // namespace

double point_triangle_step(const Corners4& x, const Corners4& d, double most, double kept) {
  return safe_step<PointTriangle>(x, d, most, kept);
}

double edge_edge_step(const Corners4& x, const Corners4& d, double most, double kept) {
  return safe_step<EdgeEdge>(x, d, most, kept);
}

}  // namespace coapt
