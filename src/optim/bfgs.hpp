// Dense BFGS (Nocedal & Wright 2006, algorithm 6.1): the method of Burlina et al. 2010. Its matrix has
// unknowns^2 entries, so problems above max_unknowns are refused with an InputError.
#pragma once

#include "optim/solver.hpp"

namespace coapt {

struct BfgsOptions {
  int max_unknowns = 6000;  // 288 MB of matrix
};

std::unique_ptr<Solver> make_bfgs(const BfgsOptions& options = {});

}  // namespace coapt
