#include "image/routes/route_agreement.hpp"

#include "mesh/curve_match.hpp"
#include "mesh/distance/surface_distance.hpp"
#include "mesh/distance/triangle_tree.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kCovered = 2;  // standard deviations within which two layers agree

Points loop_of(const FoundRoute& route) { return route.mesh.vertices(Eigen::all, route.free_edge); }

}  // namespace

RouteAgreement agreement_of(const FoundRoute& first, const FoundRoute& second) {
  RouteAgreement result;
  const SurfaceDistance there = surface_distance(first.mesh, second.mesh),
                        back = surface_distance(second.mesh, first.mesh);
  result.distances = there.vertex_distances;
  result.mean = 0.5 * (there.mean + back.mean);
  result.p95 = std::max(there.p95, back.p95);
  result.free_edge =
      0.5 * (mean_distance(loop_of(first), loop_of(second)) + mean_distance(loop_of(second), loop_of(first)));
  result.has_edges_apart =
      result.free_edge > kCovered * std::hypot(first.edge_deviation, second.edge_deviation);
  const Vector areas = nodal_areas(first.mesh.vertices, first.mesh.triangles);
  result.area_difference = surface_area(second.mesh.vertices, second.mesh.triangles) / areas.sum() - 1;
  const TriangleTree tree(second.mesh.vertices, second.mesh.triangles);
  for (Eigen::Index v = 0; v < areas.size(); ++v) {
    const ClosestOnSurface near = tree.closest(first.mesh.vertices.col(v));
    double other = 0;
    for (int k = 0; k < 3; ++k)
      other += near.weights[k] * second.deviation[second.mesh.triangles(k, near.triangle)];
    const double both = first.deviation[v] * first.deviation[v] + other * other;
    if (near.distance_squared > kCovered * kCovered * both) result.apart_share += areas[v] / areas.sum();
  }
  return result;
}

}  // namespace coapt
