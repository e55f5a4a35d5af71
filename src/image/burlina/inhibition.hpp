// Burlina et al. 2010, eq. 7 and 8: where a contour slows down and stops.
#pragma once

#include "image/volume.hpp"

#include <vector>

namespace coapt {

// Eq. 7, the edges of the image: g = 1 / (1 + a |grad G * I|^2), G a Gaussian of this standard deviation
// [mm]. The paper gives no number for a: it is such that g is one half at the median gradient in the
// ball of this radius around the seed [mm]. g is zero nowhere: a contour stops at an edge only where the area
// term of eq. 9 holds it (edge_level_set()). Throws InputError where the ball holds no voxel of the volume,
// or the same values.
Volume edge_inhibition(const Volume& volume, double scale, const Vec3& seed, double radius);

// Eq. 8, the intensity: how far it departs from that of the blood in the ball of this radius around the seed
// [mm], whose middle and deviation are m and s: median and 1.48 median departures, and not the paper's mean
// and variance, because chords pass through such a ball. As printed g = 1 - M / max(M), M = (I - m)^2 / s^2:
// with the brightest voxel of a volume as the unit a leaflet that is half as bright still has 0.75, and
// nothing stops there. Here g = exp(-M / 2), the likelihood of the intensity in blood over its greatest: 1 in
// blood, 0 in tissue and in the dark beyond the sector. (The paper writes M once as square of I - m over s^2
// and divides I - m itself; the former is meant.) Throws InputError where the ball holds no voxel of the
// volume, or the same values.
Volume intensity_inhibition(const Volume& volume, const Vec3& seed, double radius);

// Of the voxels in a ball [mm], in their order.
std::vector<float> values_in_ball(const Volume& volume, const Vec3& centre, double radius);

}  // namespace coapt
