// The way to the full problem: prescribed motion, continuation, and renewal of loads without a potential.
#pragma once

#include "optim/monitor.hpp"

#include <string>

namespace coapt {

// How far a solver got, and what there is to say about it.
struct Outcome {
  Status status = Status::Converged;
  std::string note = {};
  bool is_on_the_way = false;  // the full problem was not reached
};

// Follows the prescribed motion and the continuation to the full problem, from result.q. Each step is solved:
// at once where the loads have a potential or the solver works from the exact force, else in rounds. Of the
// result it changes q, rounds and branch_changes. A run that is cut short stays where it had got to, with all
// loads and the full stiffness.
Outcome follow_path(Solver& solver, const Problem& problem, const StopRule& stop, Monitor& monitor,
                    Result& result);

}  // namespace coapt
