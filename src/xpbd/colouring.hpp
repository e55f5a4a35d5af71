// Constraints in classes that share no node: those of a class can be projected in any order, or side by side,
// to the same bits.
#pragma once

#include <vector>

namespace coapt {

// Class c holds the elements order[first[c]] .. order[first[c + 1] - 1], in ascending order.
struct ColourClasses {
  std::vector<int> order;
  std::vector<int> first;

  int count() const { return static_cast<int>(first.size()) - 1; }
};

// Greedy: each element in turn gets the first colour that none of its nodes has yet. Deterministic.
// nodes: width per element. Pre: all are in [0, node_count).
ColourClasses colour_classes(const std::vector<int>& nodes, int width, int node_count);

}  // namespace coapt
