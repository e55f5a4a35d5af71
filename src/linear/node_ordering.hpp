// In which order the nodes of a sparse symmetric matrix are eliminated.
#pragma once

#include "linear/permuted_matrix.hpp"

#include <vector>

namespace coapt {

// Approximate minimum degree, by Eigen: result[k] is the node that comes k-th.
std::vector<int> minimum_degree_order(const NodeGraph& graph);

// Nested dissection by METIS where the build has it, which large graphs take less fill by; approximate
// minimum degree for small ones, and in a build without METIS.
std::vector<int> node_order(const NodeGraph& graph);

}  // namespace coapt
