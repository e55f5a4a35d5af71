// An order of elimination for a graph that has lost and gained a few edges since the order was made.
#pragma once

#include "linear/supernodes.hpp"

#include <functional>
#include <utility>
#include <vector>

namespace coapt {

// An edge between two branches of the elimination tree fills one of them: its columns gain a row for every
// node up to the separator where the branches meet. One end of each such edge therefore goes up to there,
// just behind the separator's own columns; all others keep their places.
//
// last: of the graph that the order was made for. graph: the same nodes. border: as in
// supernodes_of(); it stays the last.
std::vector<int> updated_order(const EliminationOrder& last, const NodeGraph& graph, int border = 0);

// The order of one pattern after another. Most differ by a few pairs in contact, and an ordering takes longer
// than the rest of an analysis.
class KeptOrder {
 public:
  KeptOrder() = default;
  KeptOrder(EliminationOrder found, double entries) : found_(std::move(found)), entries_(entries) {}

  // The last order that was found anew, updated for this graph. Found anew where there is none of as many
  // nodes, or where the updated one fills more. Where the border has other nodes, begin with a new KeptOrder.
  Supernodes supernodes(const NodeGraph& graph, const std::function<std::vector<int>()>& order,
                        int border = 0);

  // The last order that was found anew, and the entries of its factor, in blocks of 3x3.
  const EliminationOrder& found() const { return found_; }
  double entries() const { return entries_; }

 private:
  EliminationOrder found_;
  double entries_ = 0;
};

}  // namespace coapt
