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

// Nodes that may move, with the lines between them: trees, as chords branch. Each moves by itself.
class LineTrees {
 public:
  LineTrees() = default;
  explicit LineTrees(SlackLines lines);
  bool is_empty() const { return trees_.empty(); }

  // Moves the nodes of each tree that is not slack, which is each line of it by half a `share` of its length,
  // to a place near by where each is slack by about that share and at least half of it, by projections onto
  // the balls around the other ends (Bregman 1967). A tree for which none is found stays as it is. Returns
  // whether any node moved. x: 3 x node_count. Allocates nothing.
  bool slacken(double share, Points& x);

 private:
  struct Tree {
    std::vector<int> nodes;  // that may move and that lines tie to each other
    std::vector<int> lines;  // all that end at them
  };
  bool is_slack(const Tree& tree, double share, const Points& x) const;
  bool is_line_slack(int line, double share, const Points& x) const;
  void shorten(int line, double share, Points& x) const;
  bool make_slack(const Tree& tree, double share, Points& x) const;

  SlackLines lines_;
  std::vector<Tree> trees_;  // in the order of their first nodes
  Points moved_;
};

}  // namespace coapt
