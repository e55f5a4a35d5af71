// Building with parts that a program has in memory.
#pragma once

#include "scene/build/groundwork.hpp"
#include "scene/build/in_memory.hpp"

namespace coapt {

// As from the scene's own file; what is wrong with the mesh is said of kMeshInMemory.
Groundwork lay_groundwork(const Scene& scene, TriangleMesh mesh);

// With the given terms behind those of the scene. Names must differ.
Model build(const Scene& scene, const Groundwork& ground, const GivenTerms& given);

// The terms alone, in the order of an objective's.
std::vector<TermPointer> build_terms(const Scene& scene, const Groundwork& ground);

}  // namespace coapt
