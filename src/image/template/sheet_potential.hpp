// The potential that a template is drawn by.
#pragma once

#include "image/template/spline_field.hpp"
#include "image/volume.hpp"

namespace coapt {

// Minus the strength, to a strength of 1.5 at most; and where no voxel of half the strength is near, a field
// that rises with the distance from these, by a half over 5 mm, so that a template is drawn to a sheet that
// it does not touch. strength: 1 for leaflets.
SplineField sheet_potential(const Volume& strength);

}  // namespace coapt
