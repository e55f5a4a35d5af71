// Mesh cascade: the scene is solved on coarser meshes first, and each shape found starts the next.
#pragma once

#include "scene/groundwork.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace coapt {

struct CascadeLevel {
  int triangles = 0;
  int iterations = 0;
  Status status = Status::Converged;
  double residual = 0;           // relative, on its own mesh
  double wall_s = 0, cpu_s = 0;  // of coarsening, building and solving
};

struct CascadeOutcome {
  // On the scene's own mesh. Times and the seconds of the trace include all levels; iterations, evaluations
  // and the trace are those of this mesh, and phase "coarse_levels" holds the time of the others.
  Result result;
  std::vector<CascadeLevel> levels;  // coarsest first, the scene's own mesh last; alone: none was coarser
  std::vector<std::string> warnings;
};

// Makes a solver for a model; methods that move masses need to know what they are.
using SolverMaker = std::function<std::unique_ptr<Solver>(const Model& model)>;

// The prescribed motion is followed on the coarsest mesh alone; finer ones start where it ends. The meshes of
// the cascade have about a quarter of the triangles of the next. Coarser meshes are solved to a loose
// tolerance; where one of them fails, or the shape found does not lead to an equilibrium on the scene's own
// mesh, that is solved from its own start, with a warning. The stop rule holds for the whole, its iterations
// for each level. The observer sees the iterates of every level, whose unknowns are those of that level.
// ground, model: of the scene's own mesh, whose result gets the certificate that `stability` asks for.
CascadeOutcome solve_cascade(const Scene& scene, const Groundwork& ground, Model& model,
                             const SolverMaker& make_solver, const StopRule& stop,
                             const Observer& observer = {}, const StabilityOptions& stability = {});

}  // namespace coapt
