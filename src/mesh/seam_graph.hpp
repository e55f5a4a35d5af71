// Chains of grid corners: the lines between nodes of a grid, linked into polylines. Private to this room.
#pragma once

#include <array>
#include <map>
#include <vector>

namespace coapt {

// A stretch between two corners, one cell long, with the triangles on its sides.
struct SeamStep {
  int from = 0, to = 0;
  std::array<int, 2> triangles{};
};

struct SeamChain {
  std::vector<int> corners;                   // the first again at the end of a closed one
  std::vector<std::array<int, 2>> triangles;  // one less
};

// Links steps between places where other than two meet. Chains of fewer than `shortest` steps that end free
// at one side and meet others at the other (spurs) go, the rest is linked anew; then isolated chains that
// short go too. The same steps give the same chains in the same order.
std::vector<SeamChain> linked_chains(std::vector<SeamStep> steps, int shortest);

}  // namespace coapt
