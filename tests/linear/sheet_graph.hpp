// A graph to order and to factorise: a sheet of nodes with a few pairs across it, in any numbering.
#pragma once

#include "linear/supernodes.hpp"

#include <algorithm>
#include <random>
#include <set>
#include <vector>

namespace coapt {

inline NodeGraph sheet_graph(int side, unsigned seed) {
  const int count = side * side;
  std::mt19937 random(seed);
  std::vector<int> number(count);
  for (int k = 0; k < count; ++k) number[k] = k;
  std::shuffle(number.begin(), number.end(), random);
  std::vector<std::set<int>> later(count);
  const auto join = [&](int a, int b) {
    later[std::min(number[a], number[b])].insert(std::max(number[a], number[b]));
  };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      const int k = i * side + j;
      join(k, k);
      if (j + 1 < side) join(k, k + 1);
      if (i + 1 < side) join(k, k + side);
      if (i + 1 < side && j + 1 < side) join(k, k + side + 1);
    }
  for (int k = 0; k < side; ++k) join(static_cast<int>(random() % count), static_cast<int>(random() % count));
  NodeGraph graph;
  for (const std::set<int>& rows : later) {
    graph.row.insert(graph.row.end(), rows.begin(), rows.end());
    graph.start.push_back(static_cast<int>(graph.row.size()));
  }
  return graph;
}

}  // namespace coapt
