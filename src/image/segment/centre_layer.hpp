// A layer that follows the ridge of a sheet moved into the middle between the sheet's two sides.
#pragma once

#include "image/segment/fit_layer.hpp"
#include "image/segment/grey_scale.hpp"
#include "image/volume.hpp"

namespace coapt {

// The middle of the sheet along the normal of each point [mm], NaN where it is not told: midway between the
// places on both sides where the signal, averaged over some millimetres of the layer, has fallen to a quarter
// of its greatest value within a millimetre of the layer. Not told where a side does not fall so far within
// 2.6 mm, as beside a wall.
Vector sheet_middles(const Volume& volume, const LayerGrid& grid, const GreyScale& scale);

// The ridge wanders with the speckle inside of a sheet that is wider than its filter, and lies nearer to the
// probe; the sides of the sheet do not. Fitted again to the middles above `ends`, the length of each column
// [mm], and to where the ridge was measured elsewhere; within 3 mm of the ends the layer moves by a part of
// that, down to none, as chords leave the sheet to one side there. `by_ridge` is the first fit.
LayerFit centre_layer(LayerGrid& grid, const LayerFit& by_ridge, const Vector& ends, const Points& annulus,
                      const SheetEvidence& ridge, const Volume& volume, const GreyScale& scale,
                      double smoothing);

// Lengths along columns whose points have moved, at the places that had these lengths before [mm].
Vector lengths_at_same_places(const Vector& lengths, const LayerGrid& before, const LayerGrid& now);

}  // namespace coapt
