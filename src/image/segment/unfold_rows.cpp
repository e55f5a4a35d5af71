#include "image/segment/unfold_rows.hpp"

#include "mesh/distance/intersections.hpp"

#include <algorithm>
#include <vector>

namespace coapt {
namespace {

constexpr int kRounds = 200;     // of smoothing at most
constexpr int kVainRounds = 20;  // without fewer bad triangles, after which the rest is no pleat

// Triangles that are folded onto a neighbour, or pass through another.
std::vector<char> bad_triangles(const TriangleMesh& mesh) {
  std::vector<char> is_bad(static_cast<size_t>(mesh.triangle_count()), 0);
  for (const Edge& edge : edges(mesh.triangles)) {
    if (edge.triangles.size() != 2) continue;
    const int s = edge.triangles[0], t = edge.triangles[1];
    if (area_vector(mesh.vertices, mesh.triangles.col(s))
            .dot(area_vector(mesh.vertices, mesh.triangles.col(t))) <= 0)
      is_bad[static_cast<size_t>(s)] = is_bad[static_cast<size_t>(t)] = 1;
  }
  for (const auto& [s, t] : intersecting_pairs(mesh.vertices, mesh.triangles))
    is_bad[static_cast<size_t>(s)] = is_bad[static_cast<size_t>(t)] = 1;
  return is_bad;
}

// Points at bad triangles, and those within so many columns of them, move.
void smooth_rows(LayerGrid& grid, const TriangleMesh& mesh, const std::vector<char>& is_bad, int reach) {
  std::vector<char> moves(static_cast<size_t>(grid.points.cols()), 0);
  for (size_t t = 0; t < is_bad.size(); ++t) {
    if (is_bad[t] == 0) continue;
    for (const int v : mesh.triangles.col(static_cast<Eigen::Index>(t)))
      for (int column = -reach; column <= reach; ++column)
        moves[static_cast<size_t>(grid.node(v % grid.columns + column, v / grid.columns))] = 1;
  }
  const LayerGrid before = grid;
  for (int row = 1; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      if (moves[static_cast<size_t>(grid.node(column, row))] != 0)
        grid.points.col(grid.node(column, row)) =
            0.25 * (before.at(column - 1, row) + 2 * before.at(column, row) + before.at(column + 1, row));
}

}  // namespace

TriangleMesh triangles_of(const LayerGrid& grid) {
  TriangleMesh mesh;
  mesh.vertices = grid.points;
  mesh.triangles.resize(3, 2 * grid.columns * (grid.rows - 1));
  Eigen::Index t = 0;
  for (int row = 0; row + 1 < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const auto a = static_cast<int>(grid.node(column, row)),
                 b = static_cast<int>(grid.node(column + 1, row));
      const auto c = static_cast<int>(grid.node(column + 1, row + 1)),
                 d = static_cast<int>(grid.node(column, row + 1));
      const bool is_short =
          (grid.points.col(a) - grid.points.col(c)).norm() < (grid.points.col(b) - grid.points.col(d)).norm();
      // Down the column, then around: the normal is that of the grid.
      mesh.triangles.col(t++) << a, d, is_short ? c : b;
      mesh.triangles.col(t++) << (is_short ? a : d), c, b;
    }
  return mesh;
}

TriangleMesh kept_part(const LayerGrid& grid, const Vector& level) {
  TriangleMesh mesh = triangles_of(grid);
  Eigen::Index count = 0;
  for (Eigen::Index t = 0; t < mesh.triangles.cols(); ++t) {
    const Eigen::Vector3i corners = mesh.triangles.col(t);
    if (level(corners).maxCoeff() > 0) mesh.triangles.col(count++) = corners;
  }
  mesh.triangles.conservativeResize(3, count);
  return mesh;
}

void unfold_rows(LayerGrid& grid, const Vector& level) {
  Points best = grid.points;
  auto least = 2 * grid.points.cols();
  for (int round = 0, vain = 0; round < kRounds && vain < kVainRounds; ++round) {
    const TriangleMesh mesh = kept_part(grid, level);
    const std::vector<char> is_bad = bad_triangles(mesh);
    const auto count = std::count(is_bad.begin(), is_bad.end(), 1);
    vain = count < least ? 0 : vain + 1;
    if (count < least) {
      least = count;
      best = grid.points;
    }
    if (count == 0) break;
    smooth_rows(grid, mesh, is_bad, vain);
  }
  grid.points = best;
}

}  // namespace coapt
