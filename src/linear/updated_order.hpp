// An order of elimination for a graph that has lost and gained a few edges since the order was made.
#pragma once

#include "linear/supernodes.hpp"

#include <functional>
#include <vector>

namespace coapt {

// Two branches of an elimination tree have no entry in common, so that an edge between them costs one of them
// all its rows up to where they meet, a separator. One end of each such edge therefore goes up to there, just
// before the separator's own columns; all others keep their places.
//
// last: of the other graph. graph: the same nodes. border: as in supernodes_of(); it stays the last.
std::vector<int> updated_order(const Supernodes& last, const NodeGraph& graph, int border = 0);

// The order of one pattern after another. Most differ by a few pairs in contact, and an ordering takes longer
// than the rest of an analysis.
class KeptOrder {
 public:
  // By the last order that was found anew, updated; anew where there is none of this many nodes or it fills
  // more.
  Supernodes supernodes(const NodeGraph& graph, const std::function<std::vector<int>()>& order,
                        int border = 0);

  // Whether there was a pattern before: contacts come and go, and this one will not last.
  bool is_changing() const { return ordered_.size() > 0; }

  void forget() { ordered_ = {}; }

 private:
  Supernodes ordered_;  // of the pattern that was ordered last
};

}  // namespace coapt
