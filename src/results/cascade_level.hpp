// What a mesh cascade found, mesh by mesh.
#pragma once

#include "optim/solver.hpp"

#include <string>
#include <vector>

namespace coapt {

struct CascadeLevel {
  int triangles = 0;
  int iterations = 0;
  Status status = Status::Converged;
  double residual = 0;           // relative, on its own mesh
  double wall_s = 0, cpu_s = 0;  // of coarsening, building and solving
  int damped_steps = 0;          // Result::damped_steps
};

struct CascadeOutcome {
  // On the scene's own mesh. Times and the seconds of the trace include all levels; iterations, evaluations
  // and the trace are those of this mesh, and phase "coarse_levels" holds the time of the others.
  Result result;
  std::vector<CascadeLevel> levels;  // coarsest first, the scene's own mesh last; alone: none was coarser
  std::vector<std::string> warnings;
};

}  // namespace coapt
