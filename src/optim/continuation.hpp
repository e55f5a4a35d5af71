// The path to the full problem: prescribed motion, continuation, and updates of loads without a potential.
#pragma once

#include "optim/monitor.hpp"
#include "optim/move_prescribed.hpp"

#include <string>

namespace coapt {

// How far a solver got, and what there is to say about it.
struct Outcome {
  Status status = Status::Converged;
  std::string note = {};
  bool is_short_of_full = false;  // the full problem was not reached
};

// Follows the prescribed motion and the continuation to the full problem, from result.q. Each step is solved:
// at once where the loads have a potential or the solver works from the exact force, else in outer
// iterations. Of the result it changes q, outer_iterations and branch_changes. A run that is cut short stays
// where it had got to, with all loads and the full stiffness.
Outcome run_continuation(Solver& solver, const Problem& problem, const StopRule& stop, Monitor& monitor,
                         Result& result);

// Whether nothing can follow on a minimization that ended like this.
bool ends_the_run(Status status);

// What there is to say where the prescribed motion goes no further.
Outcome blocked_motion(const MotionPath& motion, const Move& move, Objective& objective, const Vector& q);

// What there is to say where the energy is not finite after a prescribed motion by a share `reached` of it.
std::string lost_motion(const MotionPath& motion, double reached);

// Solves at the full problem from q, in outer iterations of the monitor's. A load without potential is
// renewed until the exact residual is small, where the solver does not work from the exact force: each of
// them minimises the potential around the last equilibrium, and the remainder contracts geometrically where
// it converges. outer_iterations: how many, added. note: what there is to say where it does not converge.
Status run_outer_iterations(Solver& solver, Objective& objective, Vector& q, Monitor& monitor,
                            double tolerance, int& outer_iterations, std::string& note);

}  // namespace coapt
