// NLopt's gradient methods behind our interface: a cross-check of our own solvers. The truncated Newton
// method of Dembo & Steihaug (preconditioned, with restarts) leads, because it still descends where the
// energy drowns in round-off; L-BFGS takes turns with it where it ends. NLopt's own tolerances are off; the
// monitor ends the run and the objective's residual decides.
#pragma once

#include "optim/solver.hpp"

namespace coapt {

// Adds "nlopt".
void add_nlopt_solver(SolverTable& table);

}  // namespace coapt
