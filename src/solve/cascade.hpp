// Mesh cascade: the scene is solved on coarser meshes first, and each shape found starts the next.
#pragma once

#include "results/cascade_level.hpp"
#include "scene/build/scene_geometry.hpp"
#include "solve/run_options.hpp"

#include <functional>
#include <memory>

namespace coapt {

// Makes a solver for a model; methods that move masses need to know what they are.
using SolverMaker = std::function<std::unique_ptr<Solver>(const Model& model)>;

// The prescribed motion and the continuation are followed on the coarsest mesh alone; finer ones start where
// it ends. The meshes of the cascade have about a quarter of the triangles of the next. Coarser meshes are
// solved to a loose tolerance; where one of them fails, or the shape found does not lead to an equilibrium on
// the scene's own mesh, that is solved from its own start, with a warning. The stop rule holds for the whole,
// its iterations for each level. The observer sees the iterates of every level, whose unknowns are those of
// that level. geometry, model: of the scene's own mesh, whose result gets the certificate that `stability`
// asks for. phase: told of each mesh as its solve begins; may be empty.
CascadeOutcome solve_cascade(const Scene& scene, const SceneGeometry& geometry, Model& model,
                             const SolverMaker& make_solver, const StopRule& stop,
                             const Continuation& continuation, const Observer& observer = {},
                             const StabilityOptions& stability = {},
                             const std::function<void(const RunPhase&)>& phase = {});

}  // namespace coapt
