// Whether a solve's own way suggests that other equilibria are near by, at no cost.
#pragma once

#include "optim/solver.hpp"
#include "results/cascade_level.hpp"

#include <string>
#include <vector>

namespace coapt {

struct NeighbourCheck {
  bool is_made = false;       // false: the method's iterates do not tell
  bool is_suspected = false;  // other equilibria
  int iterates = 0;           // of the longest way on one mesh
};

// From the iterates that newton needed. A long way is one over kinks, snaps and turns: where it ends, small
// changes decide. The way of a damped path is long by design, and is not judged. A suspicion, no proof either
// way; docs/decisions/010-branches.md has its hit rate, and why no look around the equilibrium does better.
NeighbourCheck check_neighbours(const std::string& solver, const Result& result,
                                const std::vector<CascadeLevel>& levels);

// A sentence that names the remedy; empty where nothing is suspected.
std::string neighbour_warning(const NeighbourCheck& check);

}  // namespace coapt
