#include "scene/reference_distance.hpp"

#include "mesh/surface_distance.hpp"

namespace coapt {
namespace {

DistanceFigures figures(const SurfaceDistance& distance) {
  return {distance.mean, distance.p95, distance.max};
}

}  // namespace

std::optional<ReferenceDistance> compare_with_reference(const Model& model, Fields& fields) {
  if (!model.closed_reference) return std::nullopt;
  const TriangleMesh& reference = *model.closed_reference;
  TriangleMesh closed;
  closed.vertices = fields.x.leftCols(model.mesh.vertex_count());
  closed.triangles = model.mesh.triangles;
  const SurfaceDistance there = surface_distance(closed, reference);
  fields.reference_distance = there.vertex_distances;
  ReferenceDistance distance{figures(there), figures(surface_distance(reference, closed)), std::nullopt};
  const bool is_same_mesh = reference.vertices.cols() == closed.vertices.cols() &&
                            reference.triangles.cols() == closed.triangles.cols() &&
                            reference.triangles == closed.triangles;
  if (is_same_mesh) {
    const Eigen::RowVectorXd apart = (reference.vertices - closed.vertices).colwise().norm();
    distance.same_vertex = VertexDistance{apart.mean(), apart.maxCoeff()};
  }
  return distance;
}

}  // namespace coapt
