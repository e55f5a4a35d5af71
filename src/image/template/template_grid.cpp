#include "image/template/template_grid.hpp"

#include "image/segment/annulus_region.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kSlide = 0.3;  // share of the way to equal distances around, at each resampling

Vec3 catmull_rom(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, double t) {
  return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

// A closed curve through the points of a row at a place given in points.
Vec3 around_row(const LayerGrid& grid, int row, double place) {
  const double floor = std::floor(place);
  const int k = static_cast<int>(floor);
  return catmull_rom(grid.at(k - 1, row), grid.at(k, row), grid.at(k + 1, row), grid.at(k + 2, row),
                     place - floor);
}

// The places of equal distances along a row, slid to by a share.
Vector slid_places(const LayerGrid& grid, int row, int count, double share) {
  const int n = grid.columns;
  Vector at(n + 1);
  at[0] = 0;
  for (int i = 0; i < n; ++i) at[i + 1] = at[i] + (grid.at(i + 1, row) - grid.at(i, row)).norm();
  double turn = 0;
  for (int i = 0; i < n; ++i) turn += (at[i] - at[n] * i / n) / n;
  Vector places(count);
  for (int i = 0; i < count; ++i) {
    const double own = static_cast<double>(i) * n / count;
    double wanted = at[n] * i / count + turn, turns = std::floor(wanted / at[n]);
    wanted -= turns * at[n];
    const auto next = std::upper_bound(at.begin() + 1, at.end() - 1, wanted) - at.begin();
    const double equal = static_cast<double>(next - 1) + turns * n +
                         (wanted - at[next - 1]) / std::max(at[next] - at[next - 1], 1e-12);
    places[i] = own + share * (equal - own);
  }
  return places;
}

// Points of one column at equal distances.
void even_column(const LayerGrid& from, int column, LayerGrid& to) {
  Vector at(from.rows);
  at[0] = 0;
  for (int k = 1; k < from.rows; ++k)
    at[k] = at[k - 1] + (from.at(column, k) - from.at(column, k - 1)).norm();
  for (int row = 1; row < to.rows; ++row) {
    const double wanted = at[from.rows - 1] * row / (to.rows - 1);
    int k = static_cast<int>(std::upper_bound(at.begin() + 1, at.end() - 1, wanted) - at.begin()) - 1;
    const double t = (wanted - at[k]) / std::max(at[k + 1] - at[k], 1e-12);
    const Vec3 b = from.at(column, k), c = from.at(column, k + 1);
    const Vec3 a = k > 0 ? from.at(column, k - 1) : Vec3(2 * b - c);
    const Vec3 d = k + 2 < from.rows ? from.at(column, k + 2) : Vec3(2 * c - b);
    to.points.col(to.node(column, row)) = catmull_rom(a, b, c, d, t);
  }
}

// Of a funnel: three Fourier series, each a mean and two harmonics.
using Shape = Eigen::Matrix<double, 3, 5>;
constexpr double kLeastLength = 3;  // of a leaflet [mm]

LayerGrid funnel_of(const Points& ring, const Vec3& ventricle, const Shape& shape, int rows) {
  LayerGrid grid;
  grid.columns = static_cast<int>(ring.cols());
  grid.rows = rows;
  grid.points.resize(3, ring.cols() * rows);
  const Vec3 middle = ring.rowwise().mean();
  for (int column = 0; column < grid.columns; ++column) {
    const double phi = 2 * std::numbers::pi * column / grid.columns;
    const Eigen::Vector<double, 5> series(1, std::cos(phi), std::sin(phi), std::cos(2 * phi),
                                          std::sin(2 * phi));
    const Vec3 of_column = shape * series;  // hinge angle, change of it down to the edge, length
    Vec3 tangent =
        ring.col((column + 1) % grid.columns) - ring.col((column + grid.columns - 1) % grid.columns);
    tangent -= tangent.dot(ventricle) * ventricle;
    Vec3 inward = ventricle.cross(tangent).normalized();
    if (inward.dot(middle - ring.col(column)) < 0) inward = -inward;
    const double step = std::max(of_column[2], kLeastLength) / (rows - 1);
    Vec3 x = ring.col(column);
    for (int row = 0; row < rows; ++row) {
      grid.points.col(grid.node(column, row)) = x;
      const double angle = of_column[0] + of_column[1] * (row + 0.5) / (rows - 1);
      x += step * (std::cos(angle) * inward + std::sin(angle) * ventricle);
    }
  }
  update_normals(grid);
  return grid;
}

}  // namespace

double area_cost(const LayerGrid& grid, const SplineField& potential, double cost) {
  const Vector areas = node_areas(grid);
  double sum = 0;
  for (Eigen::Index node = grid.columns; node < areas.size(); ++node)
    sum += areas[node] * (cost + potential.at(grid.points.col(node)));
  return sum;
}

LayerGrid resampled(const LayerGrid& grid, const Points& ring, int rows) {
  LayerGrid around;
  around.columns = static_cast<int>(ring.cols());
  around.rows = grid.rows;
  around.points.resize(3, ring.cols() * grid.rows);
  around.points.leftCols(ring.cols()) = ring;
  for (int row = 1; row < grid.rows; ++row) {
    const Vector places = slid_places(grid, row, around.columns, kSlide);
    for (int column = 0; column < around.columns; ++column)
      around.points.col(around.node(column, row)) = around_row(grid, row, places[column]);
  }
  LayerGrid even;
  even.columns = around.columns;
  even.rows = rows;
  even.points.resize(3, ring.cols() * rows);
  even.points.leftCols(ring.cols()) = ring;
  for (int column = 0; column < even.columns; ++column) even_column(around, column, even);
  update_normals(even);
  return even;
}

LayerGrid funnel(const Points& ring, const Vec3& ventricle, const SplineField& potential, double cost,
                 int rows) {
  const double diameter = plane_of(ring).diameter;
  const Vec3 first_steps(0.3, 0.3, 0.1 * diameter);
  Shape best = Shape::Zero();
  double least = kInfinity;
  for (const double angle : {0.5, 0.9, 1.3}) {
    Shape shape = Shape::Zero();
    shape.col(0) = Vec3(angle, 0.2, 0.35 * diameter);
    double now = area_cost(funnel_of(ring, ventricle, shape, rows), potential, cost);
    for (double size = 1; size > 0.1; size *= 0.6)
      for (bool has_moved = true; has_moved;) {
        has_moved = false;
        for (int series = 0; series < 3; ++series)
          for (int term = 0; term < 5; ++term)
            for (const double sign : {1.0, -1.0}) {
              Shape tried = shape;
              tried(series, term) += sign * size * first_steps[series];
              const double value = area_cost(funnel_of(ring, ventricle, tried, rows), potential, cost);
              if (value > now - 1e-3 * std::abs(now)) continue;
              now = value;
              shape = tried;
              has_moved = true;
            }
      }
    if (now >= least) continue;
    least = now;
    best = shape;
  }
  return funnel_of(ring, ventricle, best, rows);
}

}  // namespace coapt
