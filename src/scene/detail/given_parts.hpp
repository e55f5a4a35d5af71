// Building with parts that a program has in memory. Private to this room.
#pragma once

#include "scene/given.hpp"
#include "scene/groundwork.hpp"

namespace coapt {

// As from the scene's own file; what is wrong with the mesh is said of kMeshInMemory.
Groundwork lay_groundwork(const Scene& scene, TriangleMesh mesh);

// With the given terms behind those of the scene. Names must differ.
Model build(const Scene& scene, const Groundwork& ground, const GivenTerms& given);

}  // namespace coapt
