// Orders of elimination, and the supernodes that a factor in such an order has.
#include "linear/supernodes.hpp"

#include "linear/node_ordering.hpp"
#include "linear/sheet_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace coapt {
namespace {

// The pattern of the factor in an order, entry by entry.
std::vector<std::set<int>> eliminated(const NodeGraph& graph, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
  std::vector<std::set<int>> below(order.size());
  for (int j = 0; j < graph.size(); ++j)
    for (int k = graph.start[j]; k < graph.start[j + 1]; ++k)
      if (graph.row[k] != j)
        below[std::min(place[j], place[graph.row[k]])].insert(std::max(place[j], place[graph.row[k]]));
  for (const std::set<int>& rows : below)
    if (!rows.empty())
      for (const int row : rows)
        if (row != *rows.begin()) below[*rows.begin()].insert(row);
  return below;
}

TEST(Supernodes, HoldEveryEntryOfTheFactorAndFewOthers) {
  for (const int side : {1, 2, 5, 12, 30}) {
    const NodeGraph graph = sheet_graph(side, 7);
    const Supernodes nodes = supernodes_of(graph, minimum_degree_order(graph));
    std::vector<int> sorted = nodes.order;
    std::sort(sorted.begin(), sorted.end());
    for (int k = 0; k < graph.size(); ++k) ASSERT_EQ(sorted[k], k);
    const std::vector<std::set<int>> below = eliminated(graph, nodes.order);
    double held = 0, wanted = 0;
    for (int s = 0; s < nodes.size(); ++s)
      for (int j = nodes.first[s]; j < nodes.first[s + 1]; ++j) {
        std::set<int> rows(nodes.rows.begin() + nodes.below[s], nodes.rows.begin() + nodes.below[s + 1]);
        for (int k = j + 1; k < nodes.first[s + 1]; ++k) rows.insert(k);
        EXPECT_TRUE(std::includes(rows.begin(), rows.end(), below[j].begin(), below[j].end()));
        held += 1 + static_cast<double>(rows.size());
        wanted += 1 + static_cast<double>(below[j].size());
      }
    EXPECT_LT(held, 1.6 * wanted) << side;
  }
}

TEST(Supernodes, ComeAfterTheirChildrenAndGiveEachRowItsPlace) {
  const NodeGraph graph = sheet_graph(30, 8);
  const Supernodes nodes = supernodes_of(graph, node_order(graph));
  int children = 0;
  for (int s = 0; s < nodes.size(); ++s) {
    for (int k = nodes.child_start[s]; k < nodes.child_start[s + 1]; ++k, ++children) {
      EXPECT_LT(nodes.child[k], s);
      EXPECT_EQ(nodes.parent[nodes.child[k]], s);
    }
    const int parent = nodes.parent[s];
    if (parent < 0) continue;
    for (int k = nodes.below[s]; k < nodes.below[s + 1]; ++k) {
      const int place = nodes.place[k];
      const int row = place < nodes.columns(parent)
                          ? nodes.first[parent] + place
                          : nodes.rows[nodes.below[parent] + place - nodes.columns(parent)];
      EXPECT_EQ(row, nodes.rows[k]);
    }
  }
  EXPECT_EQ(children,
            nodes.size() - static_cast<int>(std::count(nodes.parent.begin(), nodes.parent.end(), -1)));
}

TEST(NodeOrdering, NestedDissectionOrMinimumDegreeIsAPermutationWithLittleFill) {
  const NodeGraph graph = sheet_graph(60, 9);
  std::vector<int> natural(graph.size());
  for (int k = 0; k < graph.size(); ++k) natural[k] = k;
  const auto fill = [&](const std::vector<int>& order) {
    const Supernodes nodes = supernodes_of(graph, order);
    double size = 0;
    for (int s = 0; s < nodes.size(); ++s)
      size += nodes.columns(s) * (nodes.columns(s) + nodes.rows_below(s));
    return size;
  };
  EXPECT_LT(fill(node_order(graph)), 0.2 * fill(natural));
  EXPECT_LT(fill(minimum_degree_order(graph)), 0.2 * fill(natural));
}

TEST(EliminationOrder, IsConsistentAsItWasFoundAndNoMoreWithANumberChanged) {
  const EliminationOrder found = supernodes_of(sheet_graph(20, 9), minimum_degree_order(sheet_graph(20, 9)));
  EXPECT_TRUE(EliminationOrder().is_consistent());
  EXPECT_TRUE(found.is_consistent());
  const auto with = [&](std::vector<int> EliminationOrder::*of, size_t at, int value) {
    EliminationOrder changed = found;
    (changed.*of)[at] = value;
    return changed.is_consistent();
  };
  for (const int node : {-1, 400, found.order[7]})
    EXPECT_FALSE(with(&EliminationOrder::order, 3, node)) << node;
  for (const int column : {-1, 0, found.first[2], 400, 1 << 30})
    EXPECT_FALSE(with(&EliminationOrder::first, 1, column)) << column;
  EXPECT_FALSE(with(&EliminationOrder::first, 0, 1));
  for (const int parent : {-2, 0, 1, found.size(), 1 << 30})
    EXPECT_FALSE(with(&EliminationOrder::parent, 1, parent)) << parent;
  EliminationOrder shorter = found;
  shorter.parent.pop_back();
  EXPECT_FALSE(shorter.is_consistent());
  shorter = found;
  shorter.order.pop_back();
  EXPECT_FALSE(shorter.is_consistent());
}

}  // namespace
}  // namespace coapt
