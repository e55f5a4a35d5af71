// What one factorisation costs: the unit of a benchmark that holds on other machines. Private to this room.
#pragma once

#include "scene/build/scene_geometry.hpp"
#include "solve/solve_scene.hpp"

namespace coapt {

// CPU time of one Hessian of projected elements at x (3 x node_count) and of its factorisation, without the
// symbolic analysis: the least of three [s].
double factorisation_seconds(const Scene& scene, const SceneGeometry& geometry, const SolveSetup& setup,
                             const Points& x);

}  // namespace coapt
