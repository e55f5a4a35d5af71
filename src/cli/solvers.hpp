// The solvers of this build of the command.
#pragma once

#include "optim/solver.hpp"

namespace coapt::cli {

SolverTable all_solvers();

}  // namespace coapt::cli
