// How far ultrasound is spread, from the speckle that it makes.
#pragma once

#include "image/segment/grey_scale.hpp"
#include "image/segment/layer_grid.hpp"
#include "image/volume.hpp"

#include <array>
#include <optional>
#include <vector>

namespace coapt {

// The blur as it varies over a volume: across a beam it grows with the distance from the probe.
struct SpeckleBlur {
  // Standard deviations of the Gaussian spread of power along the axes of the volume [mm].
  Vec3 at(const Vec3& position) const;

  Volume frame;         // of the volume, without values
  double variance = 0;  // of the logarithm of speckle [squared values]
  // Of neighbours along each axis, half the mean squared difference: at the middle of the volume, and how
  // much it changes from there to its end along i, j, k. Not there: too few neighbours.
  std::array<std::optional<Eigen::Vector4d>, 3> variograms;
};

// In fully developed speckle the envelope's field is correlated as the point spread itself, so that the
// correlation of the logarithm over a distance says how wide that is: Li2(x) / (pi^2 / 6) for squared
// correlation x of the field, x = exp(-d^2 / (4 s^2)) for a spread s of power. Correlations are one minus the
// variogram of neighbouring voxels, on the layer and in cubes of 4 mm that vary as speckle does, over the
// variance of the logarithm of speckle, which is known (5.57 dB squared): what varies besides, such as the
// angle to the beam, does not count. Where the layer varies less than that (the image was smoothed), over
// what it does. An axis with too few neighbours gets the mean of the others. Nothing where there are too few
// along all, or what varies is not correlated. points: 1 for the points of the layer that count. Pre: the
// scale is logarithmic.
std::optional<SpeckleBlur> speckle_blur(const Volume& volume, const LayerGrid& grid,
                                        const std::vector<char>& points, const GreyScale& scale);

}  // namespace coapt
