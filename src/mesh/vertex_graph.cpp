#include "mesh/vertex_graph.hpp"

#include <algorithm>

namespace coapt {

VertexGraph vertex_graph(const Triangles& triangles, Eigen::Index vertex_count) {
  // With repetitions first: an inner edge is met from both of its triangles.
  std::vector<int> begin(static_cast<size_t>(vertex_count) + 1, 0);
  for (const int corner : triangles.reshaped()) begin[static_cast<size_t>(corner) + 1] += 2;
  for (size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<int> met(static_cast<size_t>(begin.back())), end(begin.begin(), begin.end() - 1);
  for (Eigen::Index t = 0; t < triangles.cols(); ++t)
    for (int k = 0; k < 3; ++k) {
      int& next = end[static_cast<size_t>(triangles(k, t))];
      met[static_cast<size_t>(next++)] = triangles((k + 1) % 3, t);
      met[static_cast<size_t>(next++)] = triangles((k + 2) % 3, t);
    }
  VertexGraph graph;
  graph.start = {0};
  graph.neighbour.reserve(met.size() / 2);
  for (size_t v = 0; v + 1 < begin.size(); ++v) {
    const auto first = met.begin() + begin[v], last = met.begin() + begin[v + 1];
    std::sort(first, last);
    std::unique_copy(first, last, std::back_inserter(graph.neighbour));
    graph.start.push_back(static_cast<int>(graph.neighbour.size()));
  }
  return graph;
}

}  // namespace coapt
