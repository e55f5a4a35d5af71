// Nodes that lines alone hold, such as those where chords branch, and that bear nothing while these are
// slack.
#pragma once

#include "energy/objective.hpp"
#include "mesh/slack_lines.hpp"

namespace coapt {

// Where a line's slack ends the energy is no quadratic: Newton's method approaches it by halves (a double
// root, Decker & Kelley 1980), and a shape that lies there is no smooth function of lengths and positions.
class SlackJunctions {
 public:
  // objective: must outlive this; its lines keep their lengths.
  explicit SlackJunctions(const Objective& objective);
  bool is_empty() const { return trees_.is_empty(); }

  // Moves junctions whose lines can all be slack, and are not by a small share of their lengths, to where
  // they are, if that is near. Returns whether any moved.
  bool slacken(Vector& q);

 private:
  const Objective& objective_;
  LineTrees trees_;
  Points x_;
};

}  // namespace coapt
