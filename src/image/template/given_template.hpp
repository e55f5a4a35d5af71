// A valve as a template: its leaflets as a grid, laid onto another annulus.
#pragma once

#include "formats/valve.hpp"
#include "image/segment/layer_grid.hpp"
#include "image/template/spline_field.hpp"

namespace coapt {

// Throws InputError where the leaflets are not one layer with two rims, the annulus and the free edge that
// the valve names.
void check_template(const Valve& shape);

// As many columns as the ring (3 x n, in order) has points. The leaflets are mapped onto a ring in the plane
// (Tutte 1963), whose columns and rows are those of the grid; scaled by the lengths of both annuli, rotated
// by the least-squares motion of one annulus onto the other, and hung from the ring. Of all ways to number
// the annulus that is taken whose area times (cost + potential) is least: so it is the image that tells where
// which leaflet is. ventricle: unit vector. Throws as above.
LayerGrid given_template(const Valve& shape, const Points& ring, const Vec3& ventricle,
                         const SplineField& potential, double cost);

}  // namespace coapt
