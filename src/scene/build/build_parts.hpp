// Building with parts that a program has in memory.
#pragma once

#include "scene/build/in_memory.hpp"
#include "scene/build/scene_geometry.hpp"

namespace coapt {

// As from the scene's own file; what is wrong with the mesh is said of kMeshInMemory.
SceneGeometry scene_geometry(const Scene& scene, TriangleMesh mesh);

// With the given terms behind those of the scene. Names must differ.
Model build(const Scene& scene, const SceneGeometry& geometry, const GivenTerms& given);

// The terms alone, in the order of an objective's.
std::vector<TermPointer> build_terms(const Scene& scene, const SceneGeometry& geometry);

}  // namespace coapt
