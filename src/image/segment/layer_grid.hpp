// One layer as a grid of points: columns run from the annulus downwards, rows around the valve.
#pragma once

#include "core/types.hpp"

namespace coapt {

// Point of column i and row k: column k * columns + i of `points`. The last column is a neighbour of the
// first.
struct LayerGrid {
  int columns = 0, rows = 0;
  Points points = Points(3, 0);   // [mm]
  Points normals = Points(3, 0);  // unit, to the ventricle: the outside of the funnel that the leaflets form

  Eigen::Index node(int column, int row) const {
    const int around = (column % columns + columns) % columns;
    return static_cast<Eigen::Index>(row) * columns + around;
  }
  Vec3 at(int column, int row) const { return points.col(node(column, row)); }
};

// Normals from the neighbours of each point.
void update_normals(LayerGrid& grid);

// Length along a column from the annulus to each row, rows x columns [mm].
Eigen::MatrixXd lengths_along_columns(const LayerGrid& grid);

// The area that each point stands for [mm^2].
Vector node_areas(const LayerGrid& grid);

}  // namespace coapt
