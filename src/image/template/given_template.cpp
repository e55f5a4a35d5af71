#include "image/template/given_template.hpp"

#include "core/error.hpp"
#include "image/template/template_grid.hpp"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace coapt {
namespace {

constexpr double kInnerRadius = 0.5;  // of the free edge in the plane; that of the annulus is 1
constexpr int kRows = 9;              // of the grid
using Places = Eigen::Matrix2Xd;

// The angle of each vertex of a loop by its part of the length.
Vector angles_along(const Points& x, const std::vector<int>& loop) {
  Vector at(static_cast<Eigen::Index>(loop.size()) + 1);
  at[0] = 0;
  for (size_t k = 0; k < loop.size(); ++k)
    at[static_cast<Eigen::Index>(k) + 1] =
        at[static_cast<Eigen::Index>(k)] + (x.col(loop[(k + 1) % loop.size()]) - x.col(loop[k])).norm();
  return 2 * std::numbers::pi / at[at.size() - 1] * at.head(at.size() - 1);
}

// The angles of the free edge, which may run either way and begin anywhere: as those of the annulus across.
Vector edge_angles(const Points& x, const Valve& shape, const Vector& around) {
  const Vector along = angles_along(x, shape.free_edge);
  std::complex<double> best = 0;
  double direction = 1;
  for (const double sign : {1.0, -1.0}) {
    std::complex<double> sum = 0;
    for (size_t k = 0; k < shape.free_edge.size(); ++k) {
      Eigen::Index nearest = 0;
      (x(Eigen::all, shape.annulus).colwise() - x.col(shape.free_edge[k]))
          .colwise()
          .norm()
          .minCoeff(&nearest);
      sum += std::polar(1.0, around[nearest] - sign * along[static_cast<Eigen::Index>(k)]);
    }
    if (std::abs(sum) <= std::abs(best)) continue;
    best = sum;
    direction = sign;
  }
  return (direction * along).array() + std::arg(best);
}

// Each inner vertex in the middle of its neighbours.
Places ring_map(const TriangleMesh& mesh, const Valve& shape) {
  const int n = mesh.vertex_count();
  Places places = Places::Zero(2, n);
  std::vector<char> is_held(static_cast<size_t>(n), 0);
  const auto hold = [&](const std::vector<int>& loop, const Vector& angles, double radius) {
    for (size_t k = 0; k < loop.size(); ++k) {
      const double angle = angles[static_cast<Eigen::Index>(k)];
      places.col(loop[k]) = radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      is_held[static_cast<size_t>(loop[k])] = 1;
    }
  };
  const Vector around = angles_along(mesh.vertices, shape.annulus);
  hold(shape.annulus, around, 1);
  hold(shape.free_edge, edge_angles(mesh.vertices, shape, around), kInnerRadius);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
  for (int v = 0; v < n; ++v)
    if (is_held[static_cast<size_t>(v)]) {
      entries.emplace_back(v, v, 1.0);
      right.row(v) = places.col(v).transpose();
    }
  for (const Edge& edge : edges(mesh.triangles))
    for (const auto& [v, other] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
      if (is_held[static_cast<size_t>(v)]) continue;
      entries.emplace_back(v, v, 1.0);
      if (is_held[static_cast<size_t>(other)])
        right.row(v) += places.col(other).transpose();
      else
        entries.emplace_back(v, other, -1.0);
    }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
  return factor.solve(right).transpose();
}

// The point of the leaflets at a place in the plane: of the triangle in which it lies deepest.
Vec3 point_at(const TriangleMesh& mesh, const Places& places, const Eigen::Vector2d& p) {
  Vec3 shares = Vec3::UnitX();
  double deepest = -kInfinity;
  int triangle = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::Vector3i c = mesh.triangles.col(t);
    Eigen::Matrix2d sides;
    sides << places.col(c[1]) - places.col(c[0]), places.col(c[2]) - places.col(c[0]);
    if (sides.determinant() == 0) continue;
    const Eigen::Vector2d part = sides.inverse() * (p - places.col(c[0]));
    const Vec3 own(1 - part.sum(), part[0], part[1]);
    if (own.minCoeff() <= deepest) continue;
    deepest = own.minCoeff();
    shares = own;
    triangle = t;
  }
  shares = shares.cwiseMax(0);
  const Points corners = mesh.vertices(Eigen::all, mesh.triangles.col(triangle));
  return corners * shares / shares.sum();
}

double length_of(const Points& ring) {
  double length = 0;
  for (Eigen::Index k = 0; k < ring.cols(); ++k)
    length += (ring.col((k + 1) % ring.cols()) - ring.col(k)).norm();
  return length;
}

// The grid of the leaflets where they are, anticlockwise seen from the atrium as the ring is.
LayerGrid own_grid(const Valve& shape, int columns) {
  const Places places = ring_map(shape.leaflets, shape);
  LayerGrid grid;
  grid.columns = columns;
  grid.rows = kRows;
  grid.points.resize(3, columns * kRows);
  const Points annulus = shape.leaflets.vertices(Eigen::all, shape.annulus);
  const Vec3 middle = annulus.rowwise().mean();
  const Vec3 down = shape.leaflets.vertices.rowwise().mean() - middle;
  Vec3 area = Vec3::Zero();
  for (Eigen::Index k = 0; k < annulus.cols(); ++k)
    area += (annulus.col(k) - middle).cross(annulus.col((k + 1) % annulus.cols()) - middle);
  const double direction = area.dot(down) < 0 ? 1 : -1;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double radius = 1 - (1 - kInnerRadius) * row / (kRows - 1);
      const double angle = direction * 2 * std::numbers::pi * column / columns;
      grid.points.col(grid.node(column, row)) =
          point_at(shape.leaflets, places, radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
  return grid;
}

}  // namespace

void check_template(const Valve& shape) {
  const TriangleMesh& mesh = shape.leaflets;
  std::vector<std::string> defects;
  if (shape.annulus.size() < 5 || shape.free_edge.size() < 5)
    throw InputError(
        "the template names no annulus or no free edge; both are needed, as closed loops of vertices");
  const std::vector<std::vector<int>> loops = boundary_loops(mesh.triangles);
  const auto is_rim = [&](const std::vector<int>& loop) {
    return std::any_of(loops.begin(), loops.end(), [&](const std::vector<int>& rim) {
      return std::set<int>(rim.begin(), rim.end()) == std::set<int>(loop.begin(), loop.end());
    });
  };
  const std::vector<Edge> all = edges(mesh.triangles);
  const std::set<int> used(mesh.triangles.data(), mesh.triangles.data() + mesh.triangles.size());
  const bool is_manifold =
      std::all_of(all.begin(), all.end(), [](const Edge& edge) { return edge.triangles.size() <= 2; });
  const bool is_ring = used.size() + static_cast<size_t>(mesh.triangle_count()) == all.size() &&
                       static_cast<int>(used.size()) == mesh.vertex_count();
  if (!is_manifold || !is_ring || loops.size() != 2)
    throw InputError("the template is not one layer with two rims, as a funnel is: it has " +
                     std::to_string(loops.size()) + (loops.size() == 1 ? " rim" : " rims") +
                     ", handles, separate parts or vertices without a triangle");
  if (!is_rim(shape.annulus) || !is_rim(shape.free_edge))
    throw InputError("annulus and free edge of the template are not its two rims");
}

LayerGrid given_template(const Valve& shape, const Points& ring, const Vec3& ventricle,
                         const SplineField& potential, double cost) {
  check_template(shape);
  const int columns = static_cast<int>(ring.cols());
  const LayerGrid own = own_grid(shape, columns);
  const Points annulus = own.points.leftCols(columns);
  const double scale = length_of(ring) / length_of(annulus);
  LayerGrid best;
  double least = kInfinity;
  for (int turn = 0; turn < columns; ++turn) {
    Points from(3, columns + 1), to(3, columns + 1);  // and a place on the side of the ventricle
    for (int column = 0; column < columns; ++column) from.col(column) = scale * own.at(column + turn, 0);
    to.leftCols(columns) = ring;
    const Vec3 middle = ring.rowwise().mean();
    from.col(columns) = scale * Vec3(own.points.rowwise().mean());
    to.col(columns) =
        middle + (from.col(columns) - scale * Vec3(annulus.rowwise().mean())).norm() * ventricle;
    const Eigen::Matrix3d rotation = Eigen::umeyama(from, to, false).topLeftCorner<3, 3>();
    LayerGrid tried = own;
    for (int row = 0; row < own.rows; ++row)
      for (int column = 0; column < columns; ++column)
        tried.points.col(tried.node(column, row)) =
            ring.col(column) + scale * (rotation * (own.at(column + turn, row) - own.at(column + turn, 0)));
    const double value = area_cost(tried, potential, cost);
    if (value >= least) continue;
    least = value;
    best = std::move(tried);
  }
  update_normals(best);
  return best;
}

}  // namespace coapt
