// How fast a smoothed volume changes.
#pragma once

#include "image/volume.hpp"

namespace coapt {

// |grad G * I|, G a Gaussian of this standard deviation [mm], per mm.
Volume gradient_magnitude(const Volume& volume, double scale);

}  // namespace coapt
