// What a search for other equilibria found: a part of the report of a solve.
#pragma once

#include "optim/stability/stability.hpp"
#include "results/metrics.hpp"

#include <optional>
#include <string>
#include <vector>

namespace coapt {

struct NearbyEquilibrium {
  double energy = 0;  // [mJ]
  double residual = 0;
  Stability stability = Stability::NotKnown;
  int found = 0;                        // by how many perturbed starts
  double greatest_mm = 0, mean_mm = 0;  // distance of the nodes from the solve's own equilibrium
  Metrics metrics;
  int left_out = 0;  // nodes that one of the two does not determine: in neither distance
};

// Lowest and highest of one metric over the other equilibria.
struct BranchRange {
  std::string name;  // as in metric_rows()
  double lowest = 0, highest = 0;
};

inline constexpr int kUsualStarts = 5;  // of a search that is advised

struct Branches {
  int starts = 0;             // made; fewer than wanted where the user interrupted the search
  int starts_along_path = 0;  // of them, from the scene's own start; the others from its equilibrium
  int not_converged = 0;      // of all
  std::string first_failure;  // message of the first of these
  double kick_mm = 0;
  double least_moved_share = 1;  // of the starts: length of all moves that contact admitted, over that wanted
  double tolerance_mm = 0;       // states are the same where no determined node is farther apart
  double greatest_return_mm = 0;  // of a node of the starts that came back to the solve's own state
  std::vector<NearbyEquilibrium> equilibria;  // distinct; the solve's own first
  std::vector<BranchRange> others;            // empty: there is no other equilibrium

  // Of each node: its greatest distance from the solve's own equilibrium in the others, free nodes included
  // [mm]; all zero where there is no other.
  Vector spread_mm;

  // Those that led to an equilibrium; a search without any tells nothing.
  int converged() const { return starts - not_converged; }

  // Whether the search says more than a suspicion of other equilibria: it found one, or made as many starts
  // as whoever suspects is told to.
  bool answers_suspicion() const { return equilibria.size() > 1 || converged() >= kUsualStarts; }
};

// The range of a metric over the other equilibria; null where there is none.
const BranchRange* range_of(const std::optional<Branches>& branches, const std::string& metric);

// Nodes whose place the result does not determine.
struct UndeterminedNodes {
  int free = 0;       // by the certificate: they can be moved at no cost
  int differing = 0;  // others, that stand elsewhere in another equilibrium
  int total() const { return free + differing; }
};
UndeterminedNodes undetermined_nodes(const std::vector<int>& free_nodes,
                                     const std::optional<Branches>& branches);

// Of each node: 0 determined, 1 free by the certificate, 2 elsewhere in another equilibrium. Ascending
// free_nodes.
std::vector<char> undetermined_flags(const std::vector<int>& free_nodes,
                                     const std::optional<Branches>& branches, Eigen::Index node_count);

// The outcome in one sentence, without a full stop.
std::string branches_message(const Branches& branches);

}  // namespace coapt
