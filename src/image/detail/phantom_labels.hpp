// What each voxel of a phantom truly is.
#pragma once

#include "image/detail/heart_walls.hpp"
#include "image/phantom.hpp"

namespace coapt {

// PhantomLabel of each voxel of the grid, by its centre: leaflets are within half their thickness of the
// middle surface, chords within their radius of their line.
Volume phantom_labels(const PhantomValve& valve, const ValveFrame& frame, const HeartWalls& walls,
                      const Volume& grid, double thickness);

}  // namespace coapt
