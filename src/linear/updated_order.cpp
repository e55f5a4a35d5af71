#include "linear/updated_order.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <queue>

namespace coapt {
namespace {

// Which supernodes are above which others, and where branches meet.
class EliminationTree {
 public:
  explicit EliminationTree(const EliminationOrder& nodes) : nodes_(nodes), begin_(nodes.size()) {
    std::iota(begin_.begin(), begin_.end(), 0);
    for (int s = 0; s < nodes.size(); ++s)
      if (const int parent = nodes.parent[s]; parent >= 0)
        begin_[parent] = std::min(begin_[parent], begin_[s]);
  }
  bool are_in_line(int s, int t) const { return begin_[std::max(s, t)] <= std::min(s, t); }

  // The lowest supernode above both; size() where there is none.
  int meeting(int s, int t) const {
    while (s >= 0 && !(begin_[s] <= t && t <= s)) s = nodes_.parent[s];
    return s >= 0 ? s : nodes_.size();
  }

 private:
  const EliminationOrder& nodes_;
  std::vector<int> begin_;  // of each supernode, the first one of its subtree, which ends with it
};

// An edge between two branches.
struct Link {
  int a, b;     // nodes
  int meeting;  // supernode
};

std::vector<Link> links_of(const EliminationOrder& last, const NodeGraph& graph, int border) {
  const int inner = graph.size() - border;
  std::vector<int> supernode(graph.size(), -1);  // the border is above everything
  for (int s = 0; s < last.size(); ++s)
    for (int k = last.first[s]; k < std::min(last.first[s + 1], inner); ++k) supernode[last.order[k]] = s;
  const EliminationTree tree(last);
  std::vector<Link> links;
  for (int j = 0; j < graph.size(); ++j)
    for (int k = graph.start[j]; k < graph.start[j + 1]; ++k) {
      const int s = supernode[graph.row[k]], t = supernode[j];
      if (s < 0 || t < 0 || tree.are_in_line(s, t)) continue;
      links.push_back({graph.row[k], j, tree.meeting(s, t)});
    }
  return links;
}

// For each node the supernode to which it moves up; -1 where it stays. The node with the most links first,
// again and again, so that few move.
std::vector<int> moves(const std::vector<Link>& links, int size) {
  std::vector<std::vector<int>> of(size);
  for (int k = 0; k < static_cast<int>(links.size()); ++k)
    for (const int node : {links[k].a, links[k].b}) of[node].push_back(k);
  std::vector<int> left(size), move(size, -1);
  std::priority_queue<std::array<int, 2>> busiest;  // links that are left, node
  for (int node = 0; node < size; ++node)
    if (left[node] = static_cast<int>(of[node].size()); left[node] > 0) busiest.push({left[node], node});
  std::vector<char> is_cut(links.size(), 0);
  while (!busiest.empty()) {
    const auto [count, node] = busiest.top();
    busiest.pop();
    if (count != left[node]) continue;  // some of its links were cut since
    for (const int k : of[node]) {
      if (is_cut[k]) continue;
      is_cut[k] = 1;
      move[node] = std::max(move[node], links[k].meeting);
      const int other = links[k].a == node ? links[k].b : links[k].a;
      --left[node];
      if (--left[other] > 0) busiest.push({left[other], other});
    }
  }
  return move;
}

}  // namespace

std::vector<int> updated_order(const EliminationOrder& last, const NodeGraph& graph, int border) {
  const std::vector<Link> links = links_of(last, graph, border);
  if (links.empty()) return last.order;
  const std::vector<int> move = moves(links, graph.size());
  const int end =
      last.size() - (border > 0 ? 1 : 0);  // what has no separator above it goes before the border
  std::vector<std::vector<int>> arrivals(last.size() + 1);
  for (const int node : last.order)
    if (move[node] >= 0) arrivals[std::min(move[node], end)].push_back(node);
  std::vector<int> order;
  order.reserve(last.order.size());
  for (int s = 0; s <= last.size(); ++s) {
    if (s == end) order.insert(order.end(), arrivals[s].begin(), arrivals[s].end());
    for (int k = last.first[s]; s < last.size() && k < last.first[s + 1]; ++k)
      if (move[last.order[k]] < 0) order.push_back(last.order[k]);
    if (s != end) order.insert(order.end(), arrivals[s].begin(), arrivals[s].end());
  }
  return order;
}

Supernodes KeptOrder::supernodes(const NodeGraph& graph, const std::function<std::vector<int>()>& order,
                                 int border) {
  constexpr double kMostFill = 1.05;  // of an updated order, over that of the pattern it was made for
  if (found_.order.size() == static_cast<size_t>(graph.size())) {
    Supernodes nodes = supernodes_of(graph, updated_order(found_, graph, border), border);
    if (nodes.entries() <= kMostFill * entries_) return nodes;
  }
  Supernodes nodes = supernodes_of(graph, order(), border);
  entries_ = nodes.entries();
  found_ = nodes;  // without its rows
  return nodes;
}

}  // namespace coapt
