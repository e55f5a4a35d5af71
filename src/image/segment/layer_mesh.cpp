#include "image/segment/layer_mesh.hpp"

#include "core/error.hpp"
#include "image/segment/trim_crossings.hpp"
#include "image/segment/unfold_rows.hpp"
#include "mesh/distance/intersections.hpp"
#include "mesh/distance/triangle_tree.hpp"
#include "mesh/remesh/coarsen.hpp"
#include "mesh/remesh/cut_away.hpp"
#include "mesh/remesh/round_triangles.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace coapt {
namespace {

constexpr double kCutSnap = 0.3;    // of an edge, within which the cut goes through a vertex
constexpr double kShortEdge = 0.5;  // of the wanted length
constexpr int kRoundings = 30;      // of making triangles round
constexpr int kTrims = 10;          // meshes at most, each cut shorter where the last one crosses itself

// Without the vertices that belong to nothing.
TriangleMesh compacted(const TriangleMesh& mesh) {
  std::vector<int> number(static_cast<size_t>(mesh.vertex_count()), -1);
  for (const int v : mesh.triangles.reshaped()) number[static_cast<size_t>(v)] = 0;
  int count = 0;
  for (int& v : number)
    if (v == 0) v = count++;
  TriangleMesh result;
  result.vertices.resize(3, count);
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (number[static_cast<size_t>(v)] >= 0)
      result.vertices.col(number[static_cast<size_t>(v)]) = mesh.vertices.col(v);
  result.triangles = mesh.triangles.unaryExpr([&](int v) { return number[static_cast<size_t>(v)]; });
  return result;
}

double distance_from(const Points& ring, const Vec3& x) {
  return (ring.colwise() - x).colwise().norm().minCoeff();
}

void name_rims(LayerMesh& mesh, const LayerGrid& grid) {
  std::vector<std::vector<int>> loops = boundary_loops(mesh.mesh.triangles);
  if (loops.size() != 2)
    throw InputError(
        "the layer that was found has " + std::to_string(loops.size()) +
        " rims instead of two, annulus and free edge; leaflets longer than the greatest length that "
        "is looked for, or an annulus that is not theirs, may be the reason");
  const Points ring = grid.points.leftCols(grid.columns);
  const auto apart = [&](const std::vector<int>& loop) {
    double sum = 0;
    for (const int v : loop) sum += distance_from(ring, mesh.mesh.vertices.col(v));
    return sum / static_cast<double>(loop.size());
  };
  if (apart(loops[0]) > apart(loops[1])) std::swap(loops[0], loops[1]);
  mesh.annulus = loops[0];
  mesh.free_edge = loops[1];
}

void place_on_grid(LayerMesh& mesh, const TriangleMesh& whole) {
  const TriangleTree tree(whole.vertices, whole.triangles);
  mesh.nodes.resize(3, mesh.mesh.vertex_count());
  mesh.weights.resize(3, mesh.mesh.vertex_count());
  for (int v = 0; v < mesh.mesh.vertex_count(); ++v) {
    const ClosestOnSurface found = tree.closest(mesh.mesh.vertices.col(v));
    mesh.nodes.col(v) = whole.triangles.col(found.triangle);
    mesh.weights.col(v) = found.weights;
  }
}

LayerMesh mesh_above(const LayerGrid& grid, const TriangleMesh& whole, const Vector& ends,
                     double edge_length) {
  const TriangleMesh fine = compacted(cut_away(whole, length_left(grid, ends), kCutSnap).mesh);
  const double area = surface_area(fine.vertices, fine.triangles);
  const double wanted = area / (0.25 * std::sqrt(3.0) * edge_length * edge_length);
  LayerMesh mesh;
  mesh.mesh = coarsen(fine, {.share = std::clamp(wanted / fine.triangle_count(), 0.01, 1.0),
                             .keep = {},
                             .kinds = {},
                             .lines = {}})
                  .mesh;
  round_triangles(mesh.mesh, fine, kRoundings);
  collapse_short_edges(mesh.mesh, kShortEdge * edge_length);
  mesh.mesh = compacted(mesh.mesh);
  round_triangles(mesh.mesh, fine, kRoundings);
  name_rims(mesh, grid);
  place_on_grid(mesh, whole);
  return mesh;
}

// Ends half an edge shorter where triangles of the mesh cross: in the columns of that which is nearer to the
// end.
Vector shortened(const LayerGrid& grid, const LayerMesh& mesh,
                 const std::vector<std::array<int, 2>>& crossing, const Vector& ends, double edge_length) {
  const Vector left = at_vertices(mesh, length_left(grid, ends));
  const Triangles& triangles = mesh.mesh.triangles;
  Vector wanted = Vector::Constant(grid.columns, kInfinity);
  for (const auto& [s, t] : crossing) {
    const bool goes_first = left(triangles.col(s)).sum() < left(triangles.col(t)).sum();
    for (const int v : triangles.col(goes_first ? s : t))
      for (const int node : mesh.nodes.col(v)) {
        const int column = node % grid.columns;
        wanted[column] = ends[column] - 0.5 * edge_length;
      }
  }
  return wanted;
}

}  // namespace

LayerMesh layer_mesh(const LayerGrid& found, const Vector& ends, double edge_length) {
  LayerGrid grid = found;
  unfold_rows(grid, length_left(grid, ends));
  const TriangleMesh whole = triangles_of(grid);
  Vector kept = trim_crossings(grid, ends);
  LayerMesh best;
  size_t least = 0;
  // Sheets that lie close may cross where the triangles are greater.
  for (int round = 0; round < kTrims; ++round) {
    LayerMesh mesh = mesh_above(grid, whole, kept, edge_length);
    const auto crossing = intersecting_pairs(mesh.mesh.vertices, mesh.mesh.triangles);
    const Vector wanted = shortened(grid, mesh, crossing, kept, edge_length);
    if (round == 0 || crossing.size() < least) {
      least = crossing.size();
      best = std::move(mesh);
    }
    if (least == 0 || !lower_ends(grid, ends, wanted, kept)) break;
  }
  return best;
}

Vector at_vertices(const LayerMesh& mesh, const Vector& of_nodes) {
  Vector values(mesh.nodes.cols());
  for (Eigen::Index v = 0; v < values.size(); ++v) {
    values[v] = 0;
    for (int k = 0; k < 3; ++k) values[v] += mesh.weights(k, v) * of_nodes[mesh.nodes(k, v)];
  }
  return values;
}

}  // namespace coapt
