// The solvers of this build of the command.
#pragma once

#include "optim/solver.hpp"

namespace coapt::cli {

SolverTable all_solvers();
FactorisationTable all_factorisations();

}  // namespace coapt::cli
