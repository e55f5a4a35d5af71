// Which vertices an edge joins, in one flat list.
#pragma once

#include "core/types.hpp"

#include <span>
#include <vector>

namespace coapt {

struct VertexGraph {
  std::vector<int> start;      // vertex_count + 1 entries: where the neighbours of each vertex begin
  std::vector<int> neighbour;  // ascending for each vertex, each once

  std::span<const int> of(int vertex) const {
    const auto v = static_cast<size_t>(vertex);
    return {neighbour.data() + start[v], neighbour.data() + start[v + 1]};
  }
};

// Pre: corner indices are in range. O(n).
VertexGraph vertex_graph(const Triangles& triangles, Eigen::Index vertex_count);

}  // namespace coapt
