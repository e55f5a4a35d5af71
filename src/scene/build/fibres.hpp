// The fibre directions of a scene. Private to this room.
#pragma once

#include "scene/build/scene_geometry.hpp"
#include "scene/file/scene.hpp"

namespace coapt {

// Fills Model::fibres and Model::fibre_anisotropy by the scene's key `fibres`, or its defaults without it;
// does nothing where they are known. On a coarser mesh of a cascade they are those of the scene's own mesh.
// Warns of triangles whose direction is not determined. Throws InputError.
void find_fibres(const Scene& scene, const SceneGeometry& geometry, Model& model);

}  // namespace coapt
