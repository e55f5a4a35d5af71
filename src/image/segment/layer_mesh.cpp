#include "image/segment/layer_mesh.hpp"

#include "core/error.hpp"
#include "image/segment/round_triangles.hpp"
#include "image/segment/unfold_rows.hpp"
#include "mesh/distance/triangle_tree.hpp"
#include "mesh/remesh/coarsen.hpp"
#include "mesh/remesh/cut_away.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kCutSnap = 0.3;    // of an edge, within which the cut goes through a vertex
constexpr double kShortEdge = 0.5;  // of the wanted length
constexpr int kRoundings = 30;      // of making triangles round

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

}  // namespace

LayerMesh layer_mesh(const LayerGrid& found, const Vector& ends, double edge_length) {
  LayerGrid grid = found;
  const Eigen::MatrixXd lengths = lengths_along_columns(grid);
  Vector level(grid.points.cols());
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      level[grid.node(column, row)] = ends[column] - lengths(row, column);
  unfold_rows(grid, level);
  const TriangleMesh whole = triangles_of(grid);
  const TriangleMesh fine = compacted(cut_away(whole, level, kCutSnap).mesh);
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

Vector at_vertices(const LayerMesh& mesh, const Vector& of_nodes) {
  Vector values(mesh.nodes.cols());
  for (Eigen::Index v = 0; v < values.size(); ++v) {
    values[v] = 0;
    for (int k = 0; k < 3; ++k) values[v] += mesh.weights(k, v) * of_nodes[mesh.nodes(k, v)];
  }
  return values;
}

}  // namespace coapt
