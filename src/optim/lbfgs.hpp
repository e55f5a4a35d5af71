// Limited-memory BFGS (Nocedal 1980; Liu & Nocedal 1989) with a line search that stays sound at round-off.
#pragma once

#include "optim/solver.hpp"

namespace coapt {

// Of the options: memory; is_preconditioned with factorisation. The preconditioned method starts its
// recursion from the factorised, shifted Hessian of an iterate not long past instead of a multiple of the
// identity.
std::unique_ptr<Solver> make_lbfgs(const SolverOptions& options = {});

}  // namespace coapt
