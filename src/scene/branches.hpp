// Other equilibria near the one that a solve found: where the same valve may close in several shapes, how far
// their figures differ is part of the answer.
#pragma once

#include "scene/run.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

struct BranchSearch {
  int starts = 1;          // perturbed starts, at least 1
  double kick = 1e-3;      // greatest move of a node, over the mean edge length; above 0
  std::uint64_t seed = 1;  // of the random moves: the same seed makes the same starts
};

struct NearbyEquilibrium {
  double energy = 0;  // [mJ]
  double residual = 0;
  Stability stability = Stability::NotKnown;
  int found = 0;                        // by how many perturbed starts
  double greatest_mm = 0, mean_mm = 0;  // distance of the nodes from the solve's own equilibrium
  Metrics metrics;
};

// Lowest and highest of one metric over the other equilibria.
struct BranchRange {
  std::string name;  // as in metric_rows()
  double lowest = 0, highest = 0;
};

struct Branches {
  int starts = 0;         // made; fewer than wanted where the user interrupted the search
  int not_converged = 0;  // of them
  double kick_mm = 0;
  double least_moved_share = 1;  // of the starts: length of all moves that contact admitted, over that wanted
  double tolerance_mm = 0;       // states are the same where no determined node is farther apart
  double greatest_return_mm = 0;  // of a node of the starts that came back to the solve's own state
  std::vector<NearbyEquilibrium> equilibria;  // distinct; the solve's own first
  std::vector<BranchRange> others;            // empty: there is no other equilibrium
};

// Moves every free node of run's equilibrium by a random vector, uniform in the ball of that radius, as far
// as contact admits (Objective::step_limit, for parts of the nodes apart), and solves again from there, once
// for each start. States that differ by more than a thousandth of the mean edge at a node whose place is
// determined (Certificate::free_nodes) are distinct. What is not found may be there all the same: starts are
// few, and near. options: of the solve; its time limit is that of each start, its observer sees all iterates
// and ends the search by cancelling. run.model is left at another state. Pre: run converged.
Branches find_branches(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                       const BranchSearch& search, RunReport& run);

// The outcome in one sentence, without a full stop.
std::string branches_message(const Branches& branches);

// Adds the key `branches` to a result.json that write_results() made. Throws InputError when the file cannot
// be read or written.
void add_to_result(const std::filesystem::path& result_file, const Branches& branches);

}  // namespace coapt
