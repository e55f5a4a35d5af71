// From a scene to what a solver needs.
#pragma once

#include "scene/build/model.hpp"
#include "scene/file/scene.hpp"

namespace coapt {

struct SceneGeometry;

// Threads that a solve of the scene may use, at least 1.
int thread_count(const SolverSpec& solver);

// Reads the scene's files, checks the mesh, numbers the nodes, and builds motion, terms and objective.
// What is doubtful but usable is said in Model::warnings: slack rest data, isolated vertices (prescribed, so
// that they carry no unknowns), parts that nothing keeps from shifting.
// Throws InputError with all defects that could be found, each naming its file or its place in the scene.
Model build(const Scene& scene);

// The same on nodes, sets and supports that are known already, those of a coarser mesh for instance.
Model build(const Scene& scene, const SceneGeometry& geometry);

// The problem that starts at x (3 x node_count, relative to the model's origin), with the supports where
// their motion ends.
Problem problem_at(const Points& x, Model& model);

}  // namespace coapt
