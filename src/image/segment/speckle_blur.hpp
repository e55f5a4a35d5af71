// How far ultrasound is spread, from the speckle that it makes.
#pragma once

#include "image/segment/grey_scale.hpp"
#include "image/segment/layer_grid.hpp"
#include "image/volume.hpp"

#include <optional>
#include <vector>

namespace coapt {

// Standard deviations of the Gaussian spread of power along the axes of the volume [mm]. In fully developed
// speckle the envelope's field is correlated as the point spread itself, so that the correlation of the
// logarithm over a distance says how wide that is: Li2(x) / (pi^2 / 6) for squared correlation x of the
// field, x = exp(-d^2 / (4 s^2)) for a spread s of power. Correlations are one minus the variogram of
// neighbouring voxels over that of voxels 3.5 mm apart, both on the layer, along one axis; an axis with too
// few of them gets the mean of the others. Nothing where there are too few along all, or what varies is not
// correlated. points: 1 for the points of the layer that count.
std::optional<Vec3> speckle_blur(const Volume& volume, const LayerGrid& grid,
                                 const std::vector<char>& points);

}  // namespace coapt
