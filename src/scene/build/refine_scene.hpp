// A scene's nodes, sets and supports on a finer mesh than its own.
#pragma once

#include "scene/build/scene_geometry.hpp"

namespace coapt {

// Every triangle cut into four, flat: the surface at rest is the same. Chords end where they did. A new
// vertex belongs to a set, and is prescribed, where both ends of its edge are; but not in the middle of an
// inner edge that joins two places of the boundary, unless a vertex beside it that is not on the boundary is
// one of them too. It moves as the mean of both ends. Ordered sets stay in order. The result refers to
// `geometry` and to the scene's own geometry, which must outlive it.
SceneGeometry refined(const SceneGeometry& geometry);

}  // namespace coapt
