// Whether the history of a solve suggests that other equilibria are near by, without a search for them.
#pragma once

#include "optim/solver.hpp"
#include "results/cascade_level.hpp"

#include <string>
#include <vector>

namespace coapt {

struct NeighbourCheck {
  bool is_made = false;       // false: the method's iterates do not tell
  bool is_suspected = false;  // other equilibria
  int iterates = 0;           // of the longest path on one mesh; 0 along a damped path
  int unstable_steps = 0;     // Result::unstable_steps; 0 of a solve at once
};

// Of a solve at once from the iterates that newton needed: a long path is one over kinks, snaps and turns,
// and where it ends, small changes decide. Along a damped path, by any method, from the steps with
// half of the loads or more that are unstable without dampers: there the ways of neighbours part. A
// suspicion, no proof either way; docs/decisions/010-branches.md and 019-damped-path.md have the hit rates.
NeighbourCheck check_neighbours(const std::string& solver, const Result& result,
                                const std::vector<CascadeLevel>& levels);

// A sentence that names the remedy; empty where nothing is suspected.
std::string neighbour_warning(const NeighbourCheck& check);

}  // namespace coapt
