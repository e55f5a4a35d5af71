// The generated mitral valve on meshes that nest, with one and the same set of chords.
#pragma once

#include "formats/valve.hpp"

namespace coapt {

// The generated valve of about `triangles` triangles, each cut into four `refinements` times; new vertices
// lie on the smooth shape, and there are no regions. Unlike in the generator's own finer meshes the chords,
// their insertions and lengths are those of the coarse one, so that the valves of all refinements are
// discretisations of one problem. Pre: triangles >= 100.
Valve refined_mitral_valve(int triangles, int refinements);

}  // namespace coapt
