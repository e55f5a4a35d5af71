// What the Cholesky factor of a matrix looks like before any value is known: supernodes, sets of neighbouring
// columns with the same rows, on the graph of nodes (a ninth of the entries). Liu, The role of elimination
// trees in sparse factorization, SIAM J. Matrix Anal. Appl. 11 (1990); Ashcraft and Grimes, The influence of
// relaxed supernode partitions on the multifrontal method, ACM Trans. Math. Softw. 15 (1989).
#pragma once

#include "linear/permuted_matrix.hpp"

#include <vector>

namespace coapt {

// In which order nodes are eliminated, and the tree of that: columns are nodes in the new order. Children
// come before their parents, and the subtree of a supernode is a contiguous range that ends with it.
struct EliminationOrder {
  std::vector<int> order;     // order[k]: the node that comes k-th
  std::vector<int> first{0};  // supernode s has the columns first[s] ... first[s + 1] - 1
  std::vector<int> parent;    // supernode of the first row below, -1 where there is none

  int size() const { return static_cast<int>(parent.size()); }
  int columns(int s) const { return first[s + 1] - first[s]; }

  // Whether an update can begin with it: every node once, every supernode with a column and before its
  // parent. Subtrees that are not contiguous only make it fill more.
  bool is_consistent() const;
};

struct Supernodes : EliminationOrder {
  // Below its columns supernode s has the rows rows[below[s]] ... rows[below[s + 1] - 1], ascending.
  std::vector<int> below{0}, rows;
  std::vector<int> place;  // of each row in the parent's front: its columns, then its rows below
  std::vector<int> child_start{0}, child;  // the children of s: child[child_start[s]] ..., ascending

  int rows_below(int s) const { return below[s + 1] - below[s]; }
  double entries() const;  // of the factor, in blocks of 3x3
};

// order: any order of the nodes; that of the result differs by a postordering of the elimination tree, which
// changes no entry of the factor. Small supernodes are merged with their parents where few zeros come in. The
// last `border` nodes of the order stay the last ones, and are one supernode whatever couples them.
Supernodes supernodes_of(const NodeGraph& graph, const std::vector<int>& order, int border = 0);

}  // namespace coapt
