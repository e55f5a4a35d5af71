// Other equilibria near the one that a solve found: where the same valve may close in several shapes, how far
// their figures differ is part of the answer.
#pragma once

#include "results/branch_report.hpp"
#include "run/run.hpp"

#include <cstdint>

namespace coapt {

struct BranchSearch {
  int starts = 1;  // perturbed starts of each kind; with_branches() does nothing for 0
  // Greatest move of a node, over the mean edge length; above 0. docs/decisions/010-branches.md says why.
  double kick = 1e-2;
  std::uint64_t seed = 1;  // of the random moves: the same seed makes the same starts
  // Whether there are as many starts from the scene's own start too, where its path is on one mesh: small
  // changes divert the path more often than they move a state that is reached.
  bool along_path = true;
};

// Moves every free node of the report's equilibrium by a random vector, uniform in the ball of that radius,
// as far as contact admits (Objective::step_limit, for parts of the nodes apart), and solves again from
// there, once for each start; then likewise those of the scene's own start, and takes the whole path again.
// States that differ by more than a thousandth of the mean edge at a node whose place is determined
// (Certificate::free_nodes) are distinct. What is not found may be there all the same: starts are few, and
// near. options: of the solve; its time limit is that of each start, its observer sees all iterates and ends
// the search by cancelling. Pre: run converged.
Branches find_branches(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                       const BranchSearch& search, Model& model, const Report& report);

// The report with the outcome of find_branches(), where starts are wanted and its run converged, written into
// the folder (empty: nowhere) once more: what was solved is there before, however long the search takes. That
// of a run that did not converge gets a warning that nothing was looked for.
Report with_branches(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                     const BranchSearch& search, Model& model, Report report,
                     const std::filesystem::path& folder);

}  // namespace coapt
