#include "results/reference_distance.hpp"

#include "mesh/distance/surface_distance.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace coapt {
namespace {

DistanceFigures figures(const SurfaceDistance& distance) {
  return {distance.mean, distance.p95, distance.max};
}

// The facets by their corners, however a file lists them: corners in ascending order, and so the facets.
std::vector<std::array<int, 3>> facets(const Triangles& triangles) {
  std::vector<std::array<int, 3>> all;
  all.reserve(static_cast<size_t>(triangles.cols()));
  for (const auto& t : triangles.colwise()) {
    std::array<int, 3> corners{t[0], t[1], t[2]};
    std::sort(corners.begin(), corners.end());
    all.push_back(corners);
  }
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

DistanceFigures both_directions(const ReferenceDistance& distance) {
  const DistanceFigures &to = distance.to_reference, &from = distance.from_reference;
  return {(to.mean + from.mean) / 2, std::max(to.p95, from.p95), std::max(to.max, from.max)};
}

DistanceFigures distance_between(const TriangleMesh& a, const TriangleMesh& b) {
  return both_directions({figures(surface_distance(a, b)), figures(surface_distance(b, a)), std::nullopt});
}

TriangleMesh surface_at(const Model& model, const Points& x) {
  TriangleMesh surface = model.mesh;
  surface.vertices = x.leftCols(model.mesh.vertex_count());
  return surface;
}

ReferenceDistance reference_distance(const TriangleMesh& closed, const TriangleMesh& reference,
                                     Vector& vertex_distances) {
  const SurfaceDistance there = surface_distance(closed, reference);
  vertex_distances = there.vertex_distances;
  ReferenceDistance distance{figures(there), figures(surface_distance(reference, closed)), std::nullopt};
  const bool is_same_mesh = reference.vertices.cols() == closed.vertices.cols() &&
                            facets(reference.triangles) == facets(closed.triangles);
  if (is_same_mesh) {
    const Eigen::RowVectorXd apart = (reference.vertices - closed.vertices).colwise().norm();
    distance.same_vertex = VertexDistance{apart.mean(), apart.maxCoeff()};
  }
  return distance;
}

std::optional<ReferenceDistance> compare_with_reference(const Model& model, Fields& fields) {
  if (!model.closed_reference) return std::nullopt;
  return reference_distance(surface_at(model, fields.x), *model.closed_reference, fields.reference_distance);
}

}  // namespace coapt
