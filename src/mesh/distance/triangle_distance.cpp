#include "mesh/distance/triangle_distance.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kThin = 1e-4;    // square of the sine below which rounding decides too much
constexpr double kMargin = 1e-4;  // of a side; within it of an edge rounding may put a point on either side

// Parameter in [0, 1] of the point closest to p on the segment from a along u.
double closest_parameter(const Vec3& p, const Vec3& a, const Vec3& u, double length_squared) {
  return length_squared > 0 ? std::clamp((p - a).dot(u) / length_squared, 0.0, 1.0) : 0.0;
}

}  // namespace

// Candidates are a point inside the triangle and one on each edge. Each of them lies on the triangle, so the
// nearest is right even where rounding picks the wrong region. Where p lies beyond the triangle the nearest
// point is on an edge that p is beyond; of thin triangles all edges are asked.
ClosestOnTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a;
  const Vec3 normal = u.cross(v);
  const double normal_squared = normal.squaredNorm();
  ClosestOnTriangle best;
  best.distance_squared = kInfinity;
  bool is_behind[] = {false, false, false};  // p is on the inner side of the edge that begins at the corner
  if (normal_squared > 0) {
    const double longest = std::max(u.squaredNorm(), v.squaredNorm());
    const bool is_thin = normal_squared <= kThin * longest * longest;
    Vec3 w = p - a;
    double wb = w.cross(v).dot(normal) / normal_squared;
    double wc = u.cross(w).dot(normal) / normal_squared;
    if (is_thin) {  // rounding is magnified by the ratio of length to width: once more for what it left
      w -= wb * u + wc * v;
      wb += w.cross(v).dot(normal) / normal_squared;
      wc += u.cross(w).dot(normal) / normal_squared;
    }
    if (wb >= 0 && wc >= 0 && wb + wc <= 1) {
      best.weights = {1 - wb - wc, wb, wc};
      best.point = a + wb * u + wc * v;
      best.distance_squared = (p - best.point).squaredNorm();
      if (!is_thin) return best;
    } else if (!is_thin) {
      is_behind[0] = wc > kMargin;
      is_behind[1] = 1 - wb - wc > kMargin;
      is_behind[2] = wb > kMargin;
    }
  }
  const Vec3* corners[] = {&a, &b, &c};
  for (int k = 0; k < 3; ++k) {
    if (is_behind[k]) continue;
    const Vec3 &from = *corners[k], &to = *corners[(k + 1) % 3];
    const Vec3 edge = to - from;
    const double s = closest_parameter(p, from, edge, edge.squaredNorm());
    const Vec3 point = s < 1 ? Vec3(from + s * edge) : to;
    const double distance_squared = (p - point).squaredNorm();
    if (distance_squared >= best.distance_squared) continue;
    best.point = point;
    best.distance_squared = distance_squared;
    best.weights.setZero();
    best.weights[k] = 1 - s;
    best.weights[(k + 1) % 3] = s;
  }
  return best;
}

double point_triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::sqrt(closest_on_triangle(p, a, b, c).distance_squared);
}

// Either the lines are closest inside both segments, or one of the closest points is an end: one that the
// closest point of the lines is beyond. Of nearly parallel segments all ends are asked.
ClosestOnSegments closest_on_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm();
  ClosestOnSegments best;
  best.distance_squared = kInfinity;
  const auto consider = [&](double s, double t) {
    const Vec3 first = s < 1 ? Vec3(a + s * u) : b, second = t < 1 ? Vec3(c + t * v) : d;
    const double distance_squared = (first - second).squaredNorm();
    if (distance_squared < best.distance_squared) best = {first, second, s, t, distance_squared};
  };
  const Vec3 normal = u.cross(v);
  const double normal_squared = normal.squaredNorm();
  const bool is_certain = normal_squared > kThin * uu * vv;
  double s = 0, t = 0;  // of the closest points of the lines
  if (normal_squared > 0) {
    // Of nearly parallel edges s is uncertain along both; the point of cd is taken for this s, not for the
    // exact one.
    s = v.cross(w).dot(normal) / normal_squared;
    t = (a + s * u - c).dot(v) / vv;
    if (s >= 0 && s <= 1) {
      consider(s, std::clamp(t, 0.0, 1.0));
      if (is_certain && t > 0 && t < 1) return best;
    }
  }
  if (!is_certain || s < kMargin) consider(0, closest_parameter(a, c, v, vv));
  if (!is_certain || s > 1 - kMargin) consider(1, closest_parameter(b, c, v, vv));
  if (!is_certain || t < kMargin) consider(closest_parameter(c, a, u, uu), 0);
  if (!is_certain || t > 1 - kMargin) consider(closest_parameter(d, a, u, uu), 1);
  return best;
}

double segment_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return std::sqrt(closest_on_segments(a, b, c, d).distance_squared);
}

}  // namespace coapt
