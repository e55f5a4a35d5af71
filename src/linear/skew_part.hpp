// The skew part W of a tangent, which is given by its products alone, between the few nodes that it couples:
// the rim of a surface under follower pressure.
#pragma once

#include "linear/free_directions.hpp"

#include <vector>

namespace coapt {

constexpr size_t kMostBorder = 1000;  // nodes: the time of a dense factor grows with their cube

// The nodes that W couples, ascending. start: no zero where W has entries.
std::vector<int> coupled_nodes(const SkewProduct& skew, const Vector& start);

// W between the coordinates of these nodes, by its product with each of them. size: of a vector of unknowns.
Eigen::MatrixXd skew_entries(const SkewProduct& skew, const std::vector<int>& nodes, Eigen::Index size);

}  // namespace coapt
