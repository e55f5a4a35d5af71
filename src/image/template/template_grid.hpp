// Templates of leaflets, and how they are laid onto an annulus.
#pragma once

#include "image/segment/layer_grid.hpp"
#include "image/template/spline_field.hpp"

namespace coapt {

// The columns with another number of points in each, and of columns, at equal distances from the annulus to
// the free edge; points of a row slide by a share of the way to equal distances along it. ring: the first row
// (3 x columns), which is where that of the grid is, in the same order from the same start.
LayerGrid resampled(const LayerGrid& grid, const Points& ring, int rows);

// Area times (cost + potential), without that of the first row.
double area_cost(const LayerGrid& grid, const SplineField& potential, double cost);

// A funnel from a ring (3 x n, in order) whose hinge angle, bend and length are low Fourier series around
// the ring, chosen so that its area times (cost + potential) is least: by pattern search from a few angles.
// ventricle: unit vector.
LayerGrid funnel(const Points& ring, const Vec3& ventricle, const SplineField& potential, double cost,
                 int rows);

}  // namespace coapt
