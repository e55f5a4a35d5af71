// The thickness of a layer at every vertex, and the blur that it is seen through.
#pragma once

#include "image/segment/layer_mesh.hpp"
#include "image/segment/wall_profile.hpp"

#include <optional>

namespace coapt {

// Standard deviation of the blur across the layer at each of its points [mm]: as given; or of ultrasound from
// its speckle (speckle_blur.hpp); else half a voxel. Fitted together
// with the width it would take the width's place: a narrow sheet much blurred and a wide one hardly differ.
// is_seen: 1 for the points of the leaflets that the image shows.
Vector blur_across(const Volume& volume, const LayerGrid& grid, const std::vector<char>& is_seen,
                   const std::optional<double>& given, const GreyScale& scale);

// At each vertex the width of the sheet there [mm], NaN where none is found. place_deviation: of the points
// of the layer [mm].
Vector thickness_at_vertices(const Volume& volume, const LayerGrid& grid, const LayerMesh& mesh,
                             const Vector& blur, double place_deviation, const GreyScale& scale);

// The middle one of those that are finite; 0 where there are none.
double median_of_finite(const Vector& values);

}  // namespace coapt
