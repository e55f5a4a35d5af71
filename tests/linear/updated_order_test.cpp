// An order of elimination that follows pairs in contact as they come and go.
#include "linear/updated_order.hpp"

#include "linear/node_ordering.hpp"
#include "linear/sheet_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace coapt {
namespace {

using Pairs = std::vector<std::array<int, 2>>;

NodeGraph joined(const NodeGraph& graph, const Pairs& pairs) {
  std::vector<std::vector<int>> rows(graph.size());
  for (int j = 0; j < graph.size(); ++j)
    rows[j].assign(graph.row.begin() + graph.start[j], graph.row.begin() + graph.start[j + 1]);
  for (const auto& [a, b] : pairs) rows[std::min(a, b)].push_back(std::max(a, b));
  NodeGraph result;
  for (std::vector<int>& row : rows) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    result.row.insert(result.row.end(), row.begin(), row.end());
    result.start.push_back(static_cast<int>(result.row.size()));
  }
  return result;
}

// A sheet that is folded over: nodes of one part touch those that lie on them, the first `moved` rows of them
// the ones `slid` rows farther.
NodeGraph folded_sheet(int side, int slid, int moved) {
  Pairs pairs;
  const auto node = [&](int i, int j) { return i * side + j; };
  for (int i = 0; i < side; ++i)
    for (int j = 0; j < side; ++j) {
      pairs.push_back({node(i, j), node(i, j)});
      if (j + 1 < side) pairs.push_back({node(i, j), node(i, j + 1)});
      if (i + 1 < side) pairs.push_back({node(i, j), node(i + 1, j)});
      const int under = i + (i < moved ? slid : 0);
      if (j < side / 3 && under < side) pairs.push_back({node(i, j), node(under, side - 1 - j)});
    }
  NodeGraph graph;
  graph.start.assign(side * side + 1, 0);
  return joined(graph, pairs);
}

// Its nodes by nested dissection of what lies on each other before anything slid, whatever the build has.
// side: even.
void dissect(int side, int i, int j, int rows, int columns, std::vector<int>& order) {
  const auto append = [&](int at, int along, int height, int width) {
    for (int k = at; k < at + height; ++k)
      for (int l = along; l < along + width; ++l)
        order.insert(order.end(), {k * side + l, k * side + side - 1 - l});
  };
  if (rows * columns <= 4) return append(i, j, rows, columns);
  if (rows >= columns) {
    const int half = rows / 2;
    dissect(side, i, j, half, columns, order);
    dissect(side, i + half + 1, j, rows - half - 1, columns, order);
    append(i + half, j, 1, columns);
  } else {
    const int half = columns / 2;
    dissect(side, i, j, rows, half, order);
    dissect(side, i, j + half + 1, rows, columns - half - 1, order);
    append(i, j + half, rows, 1);
  }
}

std::vector<int> dissected(int side) {
  std::vector<int> order;
  dissect(side, 0, 0, side, side / 2, order);
  return order;
}

double fill(const NodeGraph& graph, const std::vector<int>& order) {
  return supernodes_of(graph, order).entries();
}

bool is_permutation(std::vector<int> order) {
  std::sort(order.begin(), order.end());
  for (int k = 0; k < static_cast<int>(order.size()); ++k)
    if (order[k] != k) return false;
  return true;
}

TEST(UpdatedOrder, StaysWhereNoEdgeJoinsTwoBranches) {
  const NodeGraph graph = folded_sheet(40, 0, 0);
  const Supernodes last = supernodes_of(graph, dissected(40));
  EXPECT_EQ(updated_order(last, graph), last.order);
  Pairs upwards;  // to what is above every node already
  for (int k = 0; k < graph.size(); k += 37) upwards.push_back({last.order[k], last.order.back()});
  EXPECT_EQ(updated_order(last, joined(graph, upwards)), last.order);
  EXPECT_EQ(updated_order(last, folded_sheet(40, 40, 40)), last.order) << "edges lost";
}

TEST(UpdatedOrder, FillsLittleMoreThanItDidAndLessThanTheLast) {
  const NodeGraph graph = folded_sheet(60, 0, 0);
  const Supernodes last = supernodes_of(graph, dissected(60));
  for (const int moved : {30, 60}) {
    const NodeGraph now = folded_sheet(60, 3, moved);
    const std::vector<int> order = updated_order(last, now);
    ASSERT_TRUE(is_permutation(order));
    EXPECT_LT(fill(now, order), 1.5 * fill(graph, last.order)) << moved;
    EXPECT_LT(fill(now, order), 0.9 * fill(now, last.order)) << moved;
  }
}

TEST(UpdatedOrder, LeavesTheBorderWhereItIs) {
  const NodeGraph graph = folded_sheet(40, 0, 0);
  const std::vector<int> border = {7, 300, 1100, 45};
  std::vector<int> order = dissected(40);
  std::erase_if(order, [&](int node) { return std::count(border.begin(), border.end(), node) > 0; });
  order.insert(order.end(), border.begin(), border.end());
  const Supernodes last = supernodes_of(graph, order, 4);
  Pairs with_border;
  for (const int node : border) with_border.push_back({node, 820});
  const NodeGraph now = joined(folded_sheet(40, 3, 40), with_border);
  const std::vector<int> updated = updated_order(last, now, 4);
  EXPECT_TRUE(is_permutation(updated));
  EXPECT_TRUE(std::equal(updated.end() - 4, updated.end(), last.order.end() - 4));
  EXPECT_LT(supernodes_of(now, updated, 4).entries(), supernodes_of(now, last.order, 4).entries());
}

TEST(UpdatedOrder, MovesWhatNothingWasAboveToTheEnd) {
  const NodeGraph sheet = folded_sheet(20, 0, 0);
  NodeGraph graph = sheet;  // two of them
  for (const int row : sheet.row) graph.row.push_back(row + sheet.size());
  for (int k = 1; k <= sheet.size(); ++k) graph.start.push_back(graph.start[sheet.size()] + sheet.start[k]);
  const Supernodes last = supernodes_of(graph, node_order(graph));
  Pairs star;
  for (int k = 0; k < sheet.size(); k += 50) star.push_back({k, sheet.size()});
  const std::vector<int> order = updated_order(last, joined(graph, star));
  EXPECT_TRUE(is_permutation(order));
  EXPECT_EQ(order.back(), sheet.size()) << "one node cuts all";
  std::vector<int> others = last.order;
  std::erase(others, sheet.size());
  EXPECT_TRUE(std::equal(others.begin(), others.end(), order.begin()));
}

TEST(KeptOrder, OrdersAnewOnlyWhereAnUpdateFillsMore) {
  const NodeGraph graph = folded_sheet(60, 0, 0);
  int calls = 0;
  KeptOrder kept;
  const auto ask = [&](const NodeGraph& of) {
    return kept.supernodes(of, [&] {
      ++calls;
      return of.size() == 3600 ? dissected(60) : minimum_degree_order(of);
    });
  };
  EXPECT_TRUE(kept.found().order.empty());
  ask(graph);
  EXPECT_GT(kept.entries(), 3600);
  EXPECT_EQ(calls, 1);
  ask(folded_sheet(60, 1, 15));
  EXPECT_EQ(ask(graph).order, supernodes_of(graph, dissected(60)).order)
      << "of the order found, not of its update";
  EXPECT_EQ(calls, 1);
  ask(folded_sheet(60, 25, 60));
  EXPECT_EQ(calls, 2);
  ask(sheet_graph(41, 2));
  EXPECT_EQ(calls, 3);
  KeptOrder given(kept.found(), kept.entries());
  const auto again = [&] {
    ++calls;
    return minimum_degree_order(sheet_graph(41, 2));
  };
  EXPECT_EQ(given.supernodes(sheet_graph(41, 2), again).order, kept.found().order);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace coapt
