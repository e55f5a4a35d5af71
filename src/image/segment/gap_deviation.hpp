// How far the layer may lie beside its place where the image does not show it.
#pragma once

#include "image/segment/layer_grid.hpp"

namespace coapt {

// At each point the standard deviation [mm] that a gap of the evidence adds to that of the noise: half the
// curvature that is not known there times the squared distance from the nearest place that is shown, as of a
// plate that goes on from the rim of the gap. Not known is by how much the curvature differs from what it is
// around: the standard deviation of the layer's curvatures where it is shown, over arms of 3 mm along rows
// and columns. evidence: 0 to 1 for each point; the first row, which is given, counts as shown.
Vector gap_deviation(const LayerGrid& grid, const Vector& evidence);

}  // namespace coapt
