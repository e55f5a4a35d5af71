#include "valve/generators/mitral_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kShrink = 0.35;  // of the height of the rows from the annulus to the free edge

// Angle at corner a of a triangle [radians].
double angle_at(const Points& x, int a, int b, int c) {
  const Vec3 ab = x.col(b) - x.col(a), ac = x.col(c) - x.col(a);
  return std::atan2(ab.cross(ac).norm(), ab.dot(ac));
}

int opposite_corner(const Eigen::Vector3i& t, const Edge& edge) {
  return *std::find_if(t.begin(), t.end(), [&](int v) { return v != edge.a && v != edge.b; });
}

// One pass over the edges; each triangle takes part in one flip at most. Returns the number of flips.
int flip_edges(const Points& x, Triangles& triangles) {
  constexpr double kTolerance = 1e-6;  // a symmetric quad must not be flipped for ever
  std::vector<bool> is_touched(static_cast<size_t>(triangles.cols()), false);
  int flips = 0;
  for (const Edge& edge : edges(triangles)) {
    if (edge.triangles.size() != 2) continue;
    const int left = edge.triangles[0], right = edge.triangles[1];
    if (is_touched[left] || is_touched[right]) continue;
    const Eigen::Vector3i t = triangles.col(left);
    const int c = opposite_corner(t, edge), d = opposite_corner(triangles.col(right), edge);
    if (angle_at(x, c, edge.a, edge.b) + angle_at(x, d, edge.a, edge.b) < std::numbers::pi + kTolerance)
      continue;
    const auto at_c = std::find(t.begin(), t.end(), c) - t.begin();
    const int a = t[(at_c + 1) % 3], b = t[(at_c + 2) % 3];  // the triangle runs c, a, b
    triangles.col(left) << c, a, d;
    triangles.col(right) << c, d, b;
    is_touched[left] = is_touched[right] = true;
    ++flips;
  }
  return flips;
}

// Rows and columns whose cells are near-equilateral on average and whose count is near the wanted one.
struct Grid {
  int rows, anterior_columns, posterior_columns;
  int columns() const { return anterior_columns + posterior_columns; }
};

Grid choose_grid(const MitralShape& shape, int triangles) {
  const double row_units =
      -std::log(1 - kShrink) / kShrink;  // rows of the annulus' height that fill a height
  const double columns_per_row = shape.annulus_over_height * 0.5 * std::numbers::sqrt3 / row_units;
  const int rows = std::max(3, static_cast<int>(std::lround(std::sqrt(triangles / (2 * columns_per_row)))));
  const int columns = std::max(8, static_cast<int>(std::lround(triangles / (2.0 * rows))));
  const int anterior = static_cast<int>(std::lround(columns * shape.anterior_share));
  return {rows, anterior, columns - anterior};
}

// u of a column position, which may lie between two columns.
double coordinate_of_column(const MitralShape& shape, const Grid& grid, double column) {
  const double share = shape.anterior_share;
  if (column <= grid.anterior_columns) return share * column / grid.anterior_columns;
  return share + (1 - share) * (column - grid.anterior_columns) / grid.posterior_columns;
}

void place_vertices(const MitralShape& shape, const Grid& grid, MitralMesh& mesh) {
  const int n = grid.columns();
  mesh.coordinates.resize(2, n * (grid.rows + 1));
  mesh.leaflets.vertices.resize(3, n * (grid.rows + 1));
  for (int j = 0; j <= grid.rows; ++j) {
    const double t = j == grid.rows ? 1 : (1 - std::pow(1 - kShrink, double(j) / grid.rows)) / kShrink;
    for (int i = 0; i < n; ++i) {
      const double u = coordinate_of_column(shape, grid, i + (j % 2) * 0.5);
      mesh.coordinates.col(j * n + i) << u, t;
      mesh.leaflets.vertices.col(j * n + i) = mitral_open_point(shape, u, t);
    }
  }
}

// Anticlockwise rows seen from the atrium, with normals that point outward and down to the ventricle.
Triangles staggered_triangles(const Grid& grid) {
  const int n = grid.columns();
  Triangles triangles(3, 2 * n * grid.rows);
  int next = 0;
  for (int j = 0; j < grid.rows; ++j)
    for (int i = 0; i < n; ++i) {
      const int k = (i + 1) % n;
      const int a = j * n + i, b = j * n + k, c = a + n, d = b + n;  // c, d: the next row towards the edge
      if (j % 2 == 0) {                                              // the next row lies half a step ahead
        triangles.col(next++) << a, c, b;
        triangles.col(next++) << b, c, d;
      } else {
        triangles.col(next++) << a, c, d;
        triangles.col(next++) << a, d, b;
      }
    }
  return triangles;
}

void name_regions(const MitralShape& shape, MitralMesh& mesh) {
  mesh.leaflets.region_names = {"anterior", "posterior"};
  for (int t = 0; t < mesh.leaflets.triangle_count(); ++t) {
    const Eigen::Vector3i v = mesh.leaflets.triangles.col(t);
    double sum = 0;  // of u, the corners brought near the first one across u = 1
    for (const int corner : v) {
      const double u = mesh.coordinates(0, corner);
      sum += u - std::round(u - mesh.coordinates(0, v[0]));
    }
    const double u = sum / 3 - std::floor(sum / 3);
    mesh.leaflets.regions.push_back(u < shape.anterior_share ? 0 : 1);
  }
}

}  // namespace

MitralMesh mitral_mesh(const MitralShape& shape, int triangles) {
  constexpr int kPasses = 50;
  const Grid grid = choose_grid(shape, triangles);
  MitralMesh mesh;
  place_vertices(shape, grid, mesh);
  mesh.leaflets.triangles = staggered_triangles(grid);
  for (int pass = 0; pass < kPasses; ++pass)
    if (flip_edges(mesh.leaflets.vertices, mesh.leaflets.triangles) == 0) break;
  name_regions(shape, mesh);
  for (std::vector<int>& loop : boundary_loops(mesh.leaflets.triangles))
    (loop.front() < grid.columns() ? mesh.annulus : mesh.free_edge) = std::move(loop);
  mesh.commissures = {0, grid.anterior_columns};
  return mesh;
}

}  // namespace coapt
