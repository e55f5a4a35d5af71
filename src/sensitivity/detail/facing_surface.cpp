#include "sensitivity/detail/facing_surface.hpp"

#include "mesh/distance/triangle_distance.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr int kWidenings = 3;         // of the search for a facet that faces the right way
constexpr double kWidening = 3;       // factor on its reach
constexpr double kLeastReach = 1e-3;  // of the extent of the surface

}  // namespace

FacingSurface::FacingSurface(const Points& x, const Triangles& triangles)
    : x_(x),
      triangles_(triangles),
      tree_(x, triangles),
      least_reach_(kLeastReach * (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).norm()) {}

Vec3 FacingSurface::facet_normal(int triangle) const {
  return (corner(triangle, 1) - corner(triangle, 0)).cross(corner(triangle, 2) - corner(triangle, 0));
}

double FacingSurface::orientation_of(const Points& x, const Points& normals, const Vector& areas) const {
  double agreement = 0;
  for (Eigen::Index v = 0; v < areas.size(); ++v)
    if (areas[v] > 0)
      agreement += areas[v] * normals.col(v).stableNormalized().dot(
                                  facet_normal(tree_.closest(x.col(v)).triangle).stableNormalized());
  return agreement < 0 ? -1 : 1;
}

ClosestPoint FacingSurface::closest(const Vec3& p, const Vec3& direction) const {
  const ClosestOnSurface nearest = tree_.closest(p);
  if (facet_normal(nearest.triangle).dot(direction) >= 0) return closest_point(nearest);
  double reach = std::max(least_reach_, kWidening * std::sqrt(nearest.distance_squared));
  for (int widening = 0; widening < kWidenings; ++widening, reach *= kWidening) {
    ClosestOnSurface found;
    found.distance_squared = reach * reach;
    for (const int t : tree_.overlapping(bounds_around(p, reach))) {
      if (facet_normal(t).dot(direction) < 0) continue;
      const ClosestOnTriangle at = closest_on_triangle(p, corner(t, 0), corner(t, 1), corner(t, 2));
      if (at.distance_squared < found.distance_squared)
        found = {t, at.point, at.weights, at.distance_squared};
    }
    if (found.triangle >= 0) return closest_point(found);
  }
  return closest_point(nearest);
}

ClosestPoint FacingSurface::closest_point(const ClosestOnSurface& at) const {
  ClosestPoint closest{{}, at.point, at.weights, Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero()};
  int on = 0, opposite = 0;
  for (int k = 0; k < 3; ++k) {
    closest.corners[static_cast<size_t>(k)] = triangles_(k, at.triangle);
    if (at.weights[k] > 0)
      ++on;
    else
      opposite = k;
  }
  if (on == 3) {
    const Vec3 area = facet_normal(at.triangle), normal = area.stableNormalized();
    closest.away = normal * normal.transpose();
    for (int k = 0; k < 3; ++k)
      closest.slopes.col(k) =
          normal.cross(corner(at.triangle, k + 2) - corner(at.triangle, k + 1)) / area.norm();
  } else if (on == 2) {
    const Vec3 edge = corner(at.triangle, opposite + 2) - corner(at.triangle, opposite + 1);
    const Vec3 along = edge.stableNormalized();
    closest.away -= along * along.transpose();
    closest.slopes.col((opposite + 2) % 3) = along / edge.norm();
    closest.slopes.col((opposite + 1) % 3) = -along / edge.norm();
  }
  return closest;
}

Points vertex_normals(const Points& x, const Triangles& triangles) {
  Points normals = Points::Zero(3, x.cols());
  for (const auto& t : triangles.colwise()) {
    const Vec3 n = (x.col(t[1]) - x.col(t[0])).cross(x.col(t[2]) - x.col(t[0]));
    for (const int corner : t) normals.col(corner) += n;
  }
  return normals;
}

}  // namespace coapt
