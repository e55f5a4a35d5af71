// Registration of two surfaces by their closest points, without any that are known.
#pragma once

#include "registration/registration.hpp"

namespace coapt {

// Trimmed closest points, point to plane (Chen & Medioni 1992; trimmed: Chetverikov et al. 2005; weights:
// Tukey's biweight), from many starts: the surfaces as they lie and turned by 28 degrees about 14
// axes, each also with the middles brought together. Both surfaces are tried as the one whose points are
// sought on the other, so that a part finds its place on the whole whichever of the two it is; one crumpled
// by noise is always the one sought. Tested from 30 degrees and 10 mm on surfaces of 40 mm.
//
// options.trim is left out of the pairs; what lies far off for another reason gets no weight either. Pairs
// with the border of a surface are left out: beyond it there is nothing to meet (Turk & Levoy 1994).
// Equal meshes are brought together to rounding. Throws InputError where less than two fifths of the points
// find a counterpart, where one surface is more than eight times as large as the other, for a mirror image
// (in a plane across an axis of the frame, then turned by up to 30 degrees), or for a surface without area.
// Pre: positions are finite.
Registration register_surfaces(const TriangleMesh& moving, const TriangleMesh& target,
                               const RegistrationOptions& options = {});

}  // namespace coapt
