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

// The same for a graph that another one follows after few factorisations: dissected where it is larger.
std::vector<int> brief_order(const NodeGraph& graph);

// The order of the last graph, for factorisations that are made one after the other of the same one, as those
// of the steps of a path and of its certificate are: an ordering takes longer than a factor of a small sheet.
class LastOrder {
 public:
  // node_order(graph): found anew where the last graph was another one. One of less than half its nodes, a
  // part that is brought into balance by itself, does not take its place.
  const std::vector<int>& of(const NodeGraph& graph);

 private:
  NodeGraph graph_;
  std::vector<int> order_, of_part_;
};

}  // namespace coapt
