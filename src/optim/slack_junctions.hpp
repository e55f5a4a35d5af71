// Nodes that lines alone hold, such as those where chords branch, and that bear nothing while these are
// slack.
#pragma once

#include "energy/objective.hpp"
#include "mesh/slack_lines.hpp"

namespace coapt {

class TermAccess;

// Where a line's slack ends the energy is no quadratic: Newton's method approaches it by halves (a double
// root, Decker & Kelley 1980), and a shape that lies there is no smooth function of lengths and positions. So
// junctions whose lines can all be slack are moved to where they are.
class SlackJunctions {
 public:
  // objective: must outlive this, and prescribe no other places meanwhile.
  explicit SlackJunctions(const Objective& objective);

  bool is_empty() const { return trees_.empty(); }

  // q: unknowns of the objective. In every tree whose lines pull by less than `most` [force], one of them not
  // slack by a small share of its length, the junctions move to where all are, if that is near. Whether any
  // moved.
  bool settle(double most, Vector& q);

 private:
  struct Element {
    const TermAccess* term;
    int index;
  };

  double force(int line) const;

  SlackLines lines_;
  std::vector<Element> elements_;  // of each line
  std::vector<LineTree> trees_;
  std::vector<int> block_;  // of unknowns, by node; -1: wholly prescribed
  Points x_;                // 3 x node_count; the ends of lines are those of the last q
};

}  // namespace coapt
