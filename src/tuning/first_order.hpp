// The response of a solved scene to its parameters, for the sliders of its page.
//
// Of all parameters that are one number, or a few that mean one thing each (a ring, a shift), the derivative
// of the shape by a usual change is taken, one linear system with the exact tangent each. For those that move
// the sheet most a range is found: at its ends the first-order shape is corrected until it is the equilibrium
// of the changed scene (TrackedEquilibrium::corrected()), and the range shrinks until it need not go far.
#pragma once

#include "results/first_order.hpp"
#include "run/run.hpp"

namespace coapt {

struct FirstOrderOptions {
  size_t most = 8;            // parameters, or as many as a page has room for
  double tolerance_mm = 0.1;  // greatest distance of a node of the sheet from a solve; of a sheet beyond
                              // 100 mm as much more
  double share = 0.5;         // of the CPU time of the solve, that they may take; but for the first of them
};

// A model of its own is built from the report's shape, which stays as it is. Nothing is thrown for what lies
// in the result: a message says why there is no response (it is not converged, its stability is in doubt, it
// is not what the scene gives again, or its tangent is singular). Stops early, with what is checked by then,
// when the observer of the options says so. Throws InputError as run() does.
FirstOrder first_order(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                       const Model& model, const Report& report, const FirstOrderOptions& wanted = {});

// For RunOptions::first_order: what first_order() finds of runs with these options. What it throws becomes
// the message.
std::function<FirstOrder(const Scene&, const Model&, const Report&)> first_order_of_runs(
    SolverTable solvers, RunOptions options, FirstOrderOptions wanted = {});

}  // namespace coapt
