#include "mesh/distance/surface_distance.hpp"

#include "core/error.hpp"
#include "mesh/distance/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace coapt {
namespace {

constexpr double kVertexWeight = 1.0 / 20, kEdgeWeight = 2.0 / 15, kCentroidWeight = 9.0 / 20;

struct Samples {
  std::vector<Vec3> points;
  std::vector<double> weights;

  void add(const Vec3& point, double weight) {
    points.push_back(point);
    weights.push_back(weight);
  }
};

// Vertices first, in their order.
Samples samples_of(const TriangleMesh& mesh) {
  Samples samples;
  const Vector nodal = nodal_areas(mesh.vertices, mesh.triangles);  // a third of the triangles around
  for (int i = 0; i < mesh.vertex_count(); ++i)
    samples.add(mesh.vertices.col(i), 3 * kVertexWeight * nodal[i]);
  std::vector<double> areas;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    areas.push_back(area_vector(mesh.vertices, mesh.triangles.col(t)).norm());
    const Vec3 sum = mesh.vertices.col(mesh.triangles(0, t)) + mesh.vertices.col(mesh.triangles(1, t)) +
                     mesh.vertices.col(mesh.triangles(2, t));
    samples.add(sum / 3, kCentroidWeight * areas.back());
  }
  for (const Edge& edge : edges(mesh.triangles)) {
    double area = 0;
    for (const int t : edge.triangles) area += areas[static_cast<size_t>(t)];
    samples.add((mesh.vertices.col(edge.a) + mesh.vertices.col(edge.b)) / 2, kEdgeWeight * area);
  }
  return samples;
}

SurfaceDistance measure(const Samples& samples, Eigen::Index vertex_count, const TriangleMesh& to) {
  if (to.triangle_count() == 0)
    throw InputError("the surface to which a distance is measured has no triangles");
  const double total = std::accumulate(samples.weights.begin(), samples.weights.end(), 0.0);
  if (!(total > 0)) throw InputError("the surface from which a distance is measured has no area");
  const TriangleTree tree(to.vertices, to.triangles);
  const size_t count = samples.points.size();
  std::vector<double> distances(count);
  SurfaceDistance result;
  result.sample_count = static_cast<int>(count);
  for (size_t i = 0; i < count; ++i) {
    distances[i] = std::sqrt(tree.closest(samples.points[i]).distance_squared);
    result.mean += distances[i] * samples.weights[i] / total;
    result.max = std::max(result.max, distances[i]);
  }
  result.vertex_distances = Eigen::Map<const Vector>(distances.data(), vertex_count);

  std::vector<size_t> order(count);
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t l, size_t r) { return distances[l] < distances[r]; });
  double below = 0;
  for (const size_t i : order) {
    result.p95 = distances[i];
    below += samples.weights[i];
    if (below >= 0.95 * total) break;
  }
  return result;
}

}  // namespace

SurfaceDistance surface_distance(const TriangleMesh& from, const TriangleMesh& to) {
  return measure(samples_of(from), from.vertices.cols(), to);
}

SurfaceDistance surface_distance(const Points& from, const TriangleMesh& to) {
  Samples samples;
  for (Eigen::Index i = 0; i < from.cols(); ++i) samples.add(from.col(i), 1);
  return measure(samples, from.cols(), to);
}

}  // namespace coapt
