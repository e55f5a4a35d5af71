// The path from the start to the full problem as a damped quasi-static motion, which defines the equilibrium
// that it comes to.
#pragma once

#include "optim/continuation.hpp"

namespace coapt {

// Follows c dq/dt = -dE/dq, with the same damping c for every node, by steps of implicit Euler: each is a
// minimum of the energy with dampers to the state before, found by the solver. Loads and prescribed motion
// grow together in continuation.damped_steps equal steps, or in fewer: the first takes three shares, since
// an open valve is stable (a sixth of fewer than 18, and at least one); a step after one in which the dampers
// pulled by less than 1e-3, or whose shape is stable without them, takes twice the share of the one before,
// up to eight times the equal one; after others, half of it. Loads grow at one rate: a step of k shares
// takes k times as long, so that its dampers are c/k. At the full problem the dampers weaken as the residual
// falls, to a hundredth where the shape is stable without them, and go at a residual of 1e-4. As a step has
// one minimum near its start, the order of nodes and the method hardly ever decide where the path leads
// (docs/decisions/019). With continuation.is_loaded the path begins at the full problem, with ten times the
// damping: for the shape that a coarser mesh gives, which may be near several equilibria of the finer one.
// There the dampers go at 1e-3 already where the shape is stable. Of the result it changes q,
// outer_iterations, damped_steps and, where the problem has a factorisation for its certificate,
// unstable_steps. A run that is cut short stays where it had got to, with all loads.
Outcome follow_damped_path(Solver& solver, const Problem& problem, const StopRule& stop, Monitor& monitor,
                           Result& result);

}  // namespace coapt
