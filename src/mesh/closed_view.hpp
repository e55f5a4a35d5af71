// A top view whose narrow slits are closed: what stands in for the thickness that a membrane does not have.
#pragma once

#include "mesh/top_view.hpp"

namespace coapt {

struct ClosedView {
  std::vector<double> height;  // per node: highest in the window, then lowest of those in the window
  std::vector<int> source;  // per node: the node that has this height, on the rim of the slit for one in it
};

// Morphological closing of the height map with a square window of 2 radius + 1 nodes: slits up to 2 radius
// cells wide fill up to where they are that wide; slopes and peaks stay. O(nodes).
// Source: Serra, Image analysis and mathematical morphology, 1982; windows by a queue of falling heights.
ClosedView closed_view(const TopView& view, int radius);

// Nodes whose window of 2 radius + 1 nodes holds one that is marked. O(nodes).
std::vector<char> near_marked(const TopView& view, const std::vector<char>& marked, int radius);

}  // namespace coapt
