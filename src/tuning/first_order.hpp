// The response of a solved scene to its parameters, for the sliders of its page.
//
// Of all parameters that are one number, or a few that mean one thing each (a ring, a shift), the derivative
// of the shape by a usual change is taken, one linear system with the exact tangent each. Those that move the
// sheet most are solved at both ends of a range, which shrinks until the solve agrees with the first order.
#pragma once

#include "results/first_order.hpp"
#include "run/run.hpp"

namespace coapt {

struct FirstOrderOptions {
  size_t most = 8;            // parameters
  double tolerance_mm = 0.1;  // greatest distance of a node of the sheet from a solve; of a sheet that is
                              // larger than 40 mm as much more
};

// A model of its own is built and solved from the report's shape, which stays as it is. Nothing is thrown for
// what lies in the result: a message says why there is no response (it is not converged, not what the scene
// gives again, or its tangent is singular). Stops early, with what is checked by then, when the observer of
// the options says so. Throws InputError as run() does.
FirstOrder first_order(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                       const Model& model, const Report& report, const FirstOrderOptions& wanted = {});

// The report with its first order, written into the folder once more (empty: nowhere): what was solved is
// there before. Where there is none the report gets a warning that says why.
Report with_first_order(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                        const Model& model, Report report, const std::filesystem::path& folder);

}  // namespace coapt
