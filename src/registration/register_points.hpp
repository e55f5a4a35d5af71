// Registration of points that are known by name, and of closed curves.
#pragma once

#include "registration/registration.hpp"

namespace coapt {

// Each landmark to that of the same place in the list (Umeyama 1991). 3 x n each, n >= 3, not on one line.
// Throws InputError for unequal numbers, too few, landmarks on one line, or a mirror image.
Registration register_landmarks(const Points& moving, const Points& target, bool with_scale = false);

// One closed curve to another by the points closest to it, point to point, as Hammer et al. 2008 do with the
// annulus (Besl & McKay 1992). Which point of the target the first one belongs to, and the sense, are not
// known: all vertices of the target are tried, matched by arc length, and the best match is the start. Equal
// curves are so matched exactly. options.trim is left out of the pairs. Points in their order, 3 x n. Throws
// InputError for curves of fewer than three points or no length, or a mirror image.
Registration register_curves(const Points& moving, const Points& target,
                             const RegistrationOptions& options = {});

}  // namespace coapt
