// Building with parts that a program has in memory. Private to this room.
#pragma once

#include "scene/given.hpp"
#include "scene/groundwork.hpp"
#include "scene/solve_scene.hpp"

namespace coapt {

// solve_setup(), without a certificate where it would need Hessians that are not there. Throws InputError for
// given terms together with a cascade.
SolveSetup given_setup(const Scene& scene, const Given& given, const SolverTable& solvers,
                       const RunOptions& options);

// Of the mesh that is given, which is taken out of it, or of the scene's own.
Groundwork given_ground(const Scene& scene, Given& given);

// A given start, 3 x node_count, relative to the model's origin. Throws InputError for another number of
// nodes and for coordinates that are not finite.
Points relative_start(const Eigen::Map<const Points>& start, const Model& model);

// As from the scene's own file; what is wrong with the mesh is said of kMeshInMemory.
Groundwork lay_groundwork(const Scene& scene, TriangleMesh mesh);

// With the given terms behind those of the scene. Names must differ.
Model build(const Scene& scene, const Groundwork& ground, const GivenTerms& given);

// The terms alone, in the order of an objective's.
std::vector<TermPointer> build_terms(const Scene& scene, const Groundwork& ground);

}  // namespace coapt
