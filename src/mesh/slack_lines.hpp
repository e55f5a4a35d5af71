// Lines that bear nothing while their ends are nearer than their length, such as chords, and the nodes
// between them that nothing else holds.
#pragma once

#include "core/types.hpp"

#include <array>
#include <vector>

namespace coapt {

struct SlackLines {
  std::vector<std::array<int, 2>> ends;  // nodes of each
  std::vector<double> lengths;           // > 0
  std::vector<char> may_move;            // by node
};

struct LineTree {
  std::vector<int> nodes;  // that may move and that lines tie to each other
  std::vector<int> lines;  // all that end at them
};

// All of them, in the order of their first nodes.
std::vector<LineTree> line_trees(const SlackLines& lines);

// Whether each line of the tree is slack by half a `share` of its length. x: 3 x node_count.
bool is_slack(const SlackLines& lines, const LineTree& tree, double share, const Points& x);

// Moves the nodes of the tree to a place near by where each line is slack by about that share and at least
// half of it, by projections onto the balls around the other ends (Bregman 1967). False where none is found;
// x is then of no use.
bool make_slack(const SlackLines& lines, const LineTree& tree, double share, Points& x);

}  // namespace coapt
