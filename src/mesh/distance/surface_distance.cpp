#include "mesh/distance/surface_distance.hpp"

#include "core/error.hpp"
#include "mesh/distance/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace coapt {
namespace {

constexpr double kVertexWeight = 1.0 / 20, kEdgeWeight = 2.0 / 15, kCentroidWeight = 9.0 / 20;

struct Samples {
  std::vector<Vec3> points;
  std::vector<double> weights;
  std::vector<char> is_counted;

  void add(const Vec3& point, double weight, bool counts = true) {
    points.push_back(point);
    weights.push_back(weight);
    is_counted.push_back(counts ? 1 : 0);
  }
};

std::vector<char> flags_of(const std::vector<int>& vertices, int vertex_count) {
  std::vector<char> flags(static_cast<size_t>(vertex_count), 0);
  for (const int v : vertices)
    if (v < vertex_count) flags[static_cast<size_t>(v)] = 1;
  return flags;
}

// Vertices first, in their order.
Samples samples_of(const TriangleMesh& mesh, const std::vector<int>& uncounted) {
  Samples samples;
  const std::vector<char> flags = flags_of(uncounted, mesh.vertex_count());
  const auto counts = [&flags](int v) { return flags[static_cast<size_t>(v)] == 0; };
  const Vector nodal = nodal_areas(mesh.vertices, mesh.triangles);  // a third of the triangles around
  for (int i = 0; i < mesh.vertex_count(); ++i)
    samples.add(mesh.vertices.col(i), 3 * kVertexWeight * nodal[i], counts(i));
  std::vector<double> areas;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    areas.push_back(area_vector(mesh.vertices, mesh.triangles.col(t)).norm());
    const int a = mesh.triangles(0, t), b = mesh.triangles(1, t), c = mesh.triangles(2, t);
    const Vec3 sum = mesh.vertices.col(a) + mesh.vertices.col(b) + mesh.vertices.col(c);
    samples.add(sum / 3, kCentroidWeight * areas.back(), counts(a) && counts(b) && counts(c));
  }
  for (const Edge& edge : edges(mesh.triangles)) {
    double area = 0;
    for (const int t : edge.triangles) area += areas[static_cast<size_t>(t)];
    samples.add((mesh.vertices.col(edge.a) + mesh.vertices.col(edge.b)) / 2, kEdgeWeight * area,
                counts(edge.a) && counts(edge.b));
  }
  return samples;
}

// Distance of every sample; those that are nearest to a triangle of an uncounted vertex count no more.
std::vector<double> distances_of(Samples& samples, const TriangleMesh& to,
                                 const std::vector<int>& uncounted) {
  const TriangleTree tree(to.vertices, to.triangles);
  const std::vector<char> flags = flags_of(uncounted, to.vertex_count());
  std::vector<double> distances(samples.points.size());
  for (size_t i = 0; i < distances.size(); ++i) {
    const ClosestOnSurface closest = tree.closest(samples.points[i]);
    distances[i] = std::sqrt(closest.distance_squared);
    for (const int v : to.triangles.col(closest.triangle))
      if (flags[static_cast<size_t>(v)] != 0) samples.is_counted[i] = 0;
  }
  return distances;
}

SurfaceDistance measure(Samples samples, Eigen::Index vertex_count, const TriangleMesh& to,
                        const std::vector<int>& uncounted) {
  if (to.triangle_count() == 0)
    throw InputError("the surface to which a distance is measured has no triangles");
  if (!(std::accumulate(samples.weights.begin(), samples.weights.end(), 0.0) > 0))
    throw InputError("the surface from which a distance is measured has no area");
  const std::vector<double> distances = distances_of(samples, to, uncounted);
  SurfaceDistance result;
  result.vertex_distances = Eigen::Map<const Vector>(distances.data(), vertex_count);

  std::vector<size_t> order;
  double total = 0;
  for (size_t i = 0; i < distances.size(); ++i) {
    if (samples.is_counted[i] == 0) continue;
    order.push_back(i);
    total += samples.weights[i];
  }
  result.sample_count = static_cast<int>(order.size());
  if (!(total > 0)) {
    result.mean = result.p95 = result.max = kNaN;
    return result;
  }
  for (const size_t i : order) {
    result.mean += distances[i] * samples.weights[i] / total;
    result.max = std::max(result.max, distances[i]);
  }
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

SurfaceDistance surface_distance(const TriangleMesh& from, const TriangleMesh& to,
                                 const UncountedVertices& uncounted) {
  return measure(samples_of(from, uncounted.from), from.vertices.cols(), to, uncounted.to);
}

SurfaceDistance surface_distance(const Points& from, const TriangleMesh& to) {
  Samples samples;
  for (Eigen::Index i = 0; i < from.cols(); ++i) samples.add(from.col(i), 1);
  return measure(std::move(samples), from.cols(), to, {});
}

}  // namespace coapt
