// Limited-memory BFGS (Nocedal 1980; Liu & Nocedal 1989) with a line search that stays sound at round-off.
#pragma once

#include "optim/solver.hpp"

namespace coapt {

struct LbfgsOptions {
  int memory = 12;  // pairs kept
};

std::unique_ptr<Solver> make_lbfgs(const LbfgsOptions& options = {});

}  // namespace coapt
