#include "stress/scenes/slivers.hpp"

#include <algorithm>

namespace coapt {
namespace {

// Vertices that lines end at, supports hold, or the boundary runs through.
std::vector<bool> bound_vertices(const SceneGeometry& geometry) {
  const TriangleMesh& mesh = geometry.model.mesh;
  std::vector<bool> kept(static_cast<size_t>(mesh.vertex_count()), false);
  const auto keep = [&](int node) {
    if (node < mesh.vertex_count()) kept[static_cast<size_t>(node)] = true;
  };
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (geometry.prescribed.fixed.col(v).any()) keep(v);
  for (const auto& [path, placed] : geometry.networks)
    for (const Chord& chord : placed.network.chords)
      for (const ChordEnd& end : {chord.from, chord.to}) keep(placed.node(end));
  for (const Edge& edge : edges(mesh.triangles))
    if (edge.triangles.size() != 2)
      for (const int v : {edge.a, edge.b}) keep(v);
  return kept;
}

// Whether every triangle of the vertex keeps its side when it moves to x.
bool keeps_sides(const TriangleMesh& mesh, const std::vector<int>& triangles, int vertex, const Vec3& x) {
  Points moved = mesh.vertices;
  moved.col(vertex) = x;
  return std::all_of(triangles.begin(), triangles.end(), [&](int t) {
    const Vec3 before = area_vector(mesh.vertices, mesh.triangles.col(t)),
               after = area_vector(moved, mesh.triangles.col(t));
    return before.dot(after) > 0.5 * before.norm() * after.norm();
  });
}

// Vertices of the triangles.
std::vector<int> corners_of(const TriangleMesh& mesh, const std::vector<int>& triangles) {
  std::vector<int> corners;
  for (const int t : triangles)
    for (const int v : mesh.triangles.col(t)) corners.push_back(v);
  return corners;
}

}  // namespace

int add_slivers(StressScene& subject, double share, int every) {
  Model& model = subject.geometry.model;
  TriangleMesh& mesh = model.mesh;
  std::vector<bool> kept = bound_vertices(subject.geometry);
  std::vector<std::vector<int>> around(kept.size());
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (const int v : mesh.triangles.col(t)) around[static_cast<size_t>(v)].push_back(t);

  int moved = 0, looked_at = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const std::vector<int>& triangles = around[static_cast<size_t>(v)];
    if (kept[static_cast<size_t>(v)] || triangles.empty() || looked_at++ % every != 0) continue;
    const std::vector<int> corners = corners_of(mesh, triangles);
    for (const int neighbour : corners) {
      if (neighbour == v) continue;
      const Vec3 to = mesh.vertices.col(neighbour);
      const Vec3 x = to + share * (mesh.vertices.col(v) - to);
      if (!keeps_sides(mesh, triangles, v, x)) continue;
      mesh.vertices.col(v) = model.X.col(v) = x;
      for (const int corner : corners) kept[static_cast<size_t>(corner)] = true;
      ++moved;
      break;
    }
  }
  return moved;
}

}  // namespace coapt
