#include "image/segment/layer_grid.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace coapt {
namespace {

// From the point before to the point after, along the ring and along the column.
Vec3 around(const LayerGrid& grid, int column, int row) {
  return grid.at(column + 1, row) - grid.at(column - 1, row);
}

Vec3 along(const LayerGrid& grid, int column, int row) {
  return grid.at(column, std::min(row + 1, grid.rows - 1)) - grid.at(column, std::max(row - 1, 0));
}

}  // namespace

void update_normals(LayerGrid& grid) {
  grid.normals.resize(3, grid.points.cols());
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      grid.normals.col(grid.node(column, row)) =
          along(grid, column, row).cross(around(grid, column, row)).normalized();
}

Eigen::MatrixXd lengths_along_columns(const LayerGrid& grid) {
  Eigen::MatrixXd lengths = Eigen::MatrixXd::Zero(grid.rows, grid.columns);
  for (int row = 1; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      lengths(row, column) =
          lengths(row - 1, column) + (grid.at(column, row) - grid.at(column, row - 1)).norm();
  return lengths;
}

Vector node_areas(const LayerGrid& grid) {
  Vector areas(grid.points.cols());
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const bool is_end = row == 0 || row == grid.rows - 1;
      areas[grid.node(column, row)] =
          (is_end ? 0.5 : 0.25) * around(grid, column, row).cross(along(grid, column, row)).norm();
    }
  return areas;
}

}  // namespace coapt
