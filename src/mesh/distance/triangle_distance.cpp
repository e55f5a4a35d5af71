#include "mesh/distance/triangle_distance.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

// Parameter in [0, 1] of the point of segment ab closest to p.
double closest_parameter(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 u = b - a;
  const double length_squared = u.squaredNorm();
  return length_squared > 0 ? std::clamp((p - a).dot(u) / length_squared, 0.0, 1.0) : 0.0;
}

}  // namespace

// Candidates are a point inside the triangle and one on each edge. Each of them lies on the triangle, so the
// nearest is right even where rounding picks the wrong region.
ClosestOnTriangle closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a;
  const Vec3 normal = u.cross(v);
  const double normal_squared = normal.squaredNorm();
  ClosestOnTriangle best;
  best.distance_squared = kInfinity;
  if (normal_squared > 0) {
    const double longest = std::max(u.squaredNorm(), v.squaredNorm());
    const bool is_thin = normal_squared <= 1e-4 * longest * longest;
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
    }
  }
  const Vec3* corners[] = {&a, &b, &c};
  for (int k = 0; k < 3; ++k) {
    const Vec3 &from = *corners[k], &to = *corners[(k + 1) % 3];
    const double s = closest_parameter(p, from, to);
    const Vec3 point = s < 1 ? Vec3(from + s * (to - from)) : to;
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

// Either the lines are closest inside both segments, or one of the closest points is an end.
ClosestOnSegments closest_on_segments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  ClosestOnSegments best;
  best.distance_squared = kInfinity;
  const auto consider = [&](double s, double t) {
    const Vec3 first = s < 1 ? Vec3(a + s * u) : b, second = t < 1 ? Vec3(c + t * v) : d;
    const double distance_squared = (first - second).squaredNorm();
    if (distance_squared < best.distance_squared) best = {first, second, s, t, distance_squared};
  };
  const Vec3 normal = u.cross(v);
  const double normal_squared = normal.squaredNorm();
  if (normal_squared > 0) {
    // Of nearly parallel edges s is uncertain along both; the point of cd is taken for this s, not for the
    // exact one.
    const double s = v.cross(w).dot(normal) / normal_squared;
    if (s >= 0 && s <= 1) {
      const double t = closest_parameter(a + s * u, c, d);
      consider(s, t);
      if (t > 0 && t < 1 && normal_squared > 1e-4 * u.squaredNorm() * v.squaredNorm())
        return best;  // certain
    }
  }
  consider(0, closest_parameter(a, c, d));
  consider(1, closest_parameter(b, c, d));
  consider(closest_parameter(c, a, b), 0);
  consider(closest_parameter(d, a, b), 1);
  return best;
}

double segment_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return std::sqrt(closest_on_segments(a, b, c, d).distance_squared);
}

}  // namespace coapt
