// Ceres' minimiser for smooth functions (GradientProblemSolver: L-BFGS with a Wolfe line search) behind our
// interface: a cross-check of our own solvers. Its own tolerances are off; the monitor ends the run and the
// objective's residual decides.
#pragma once

#include "optim/solver.hpp"

namespace coapt {

// Adds "ceres".
void add_ceres_solver(SolverTable& table);

}  // namespace coapt
