#include "linear/supernodes.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace coapt {
namespace {

// Neighbours of each node in lists, one after the other.
struct Lists {
  std::vector<int> start{0}, entry;
};

// For each node in the new order those of its neighbours that come before it.
Lists earlier_neighbours(const NodeGraph& graph, const std::vector<int>& order) {
  std::vector<int> place(graph.size());
  for (int k = 0; k < graph.size(); ++k) place[order[k]] = k;
  Lists lists;
  lists.start.assign(graph.size() + 1, 0);
  const auto visit_pairs = [&](const auto& visit) {
    for (int j = 0; j < graph.size(); ++j)
      for (int k = graph.start[j]; k < graph.start[j + 1]; ++k)
        if (graph.row[k] != j)
          visit(std::max(place[graph.row[k]], place[j]), std::min(place[graph.row[k]], place[j]));
  };
  visit_pairs([&](int later, int) { ++lists.start[later + 1]; });
  std::partial_sum(lists.start.begin(), lists.start.end(), lists.start.begin());
  lists.entry.resize(lists.start.back());
  std::vector<int> next(lists.start.begin(), lists.start.end() - 1);
  visit_pairs([&](int later, int earlier) { lists.entry[next[later]++] = earlier; });
  return lists;
}

// The parent of each column: the first row below its diagonal in the factor; -1 for a root.
std::vector<int> elimination_tree(const Lists& earlier) {
  const int size = static_cast<int>(earlier.start.size()) - 1;
  std::vector<int> parent(size, -1), ancestor(size, -1);
  for (int i = 0; i < size; ++i)
    for (int k = earlier.start[i]; k < earlier.start[i + 1]; ++k)
      for (int j = earlier.entry[k]; j != i;) {
        const int above = ancestor[j];
        ancestor[j] = i;
        if (above == -1) parent[j] = i;
        j = above == -1 ? i : above;
      }
  return parent;
}

// Children before parents, every subtree contiguous: result[k] is the column that comes k-th.
std::vector<int> postorder(const std::vector<int>& parent) {
  const int size = static_cast<int>(parent.size());
  std::vector<int> child(size, -1), sibling(size, -1), result, open;
  for (int j = size - 1; j >= 0; --j)
    if (parent[j] >= 0) {
      sibling[j] = child[parent[j]];
      child[parent[j]] = j;
    }
  result.reserve(size);
  for (int root = 0; root < size; ++root) {
    if (parent[root] >= 0) continue;
    open.push_back(root);
    while (!open.empty()) {
      const int j = open.back();
      if (child[j] >= 0) {
        open.push_back(child[j]);
        child[j] = sibling[child[j]];
      } else {
        result.push_back(j);
        open.pop_back();
      }
    }
  }
  return result;
}

// Entries of each column of the factor, its diagonal included.
std::vector<int> column_counts(const Lists& earlier, const std::vector<int>& parent) {
  const int size = static_cast<int>(parent.size());
  std::vector<int> count(size, 1), mark(size, -1);
  for (int i = 0; i < size; ++i) {
    mark[i] = i;
    for (int k = earlier.start[i]; k < earlier.start[i + 1]; ++k)
      for (int j = earlier.entry[k]; mark[j] != i; j = parent[j]) {
        ++count[j];
        mark[j] = i;
      }
  }
  return count;
}

// Entries of a trapezoid of so many columns with `below` rows under its triangle.
double trapezoid(double columns, double below) { return columns * (columns + 1) / 2 + columns * below; }

// A merged supernode of so many columns may hold that share of zeros at most: each further column makes the
// dense kernels busier. Set by hand, near those of CHOLMOD; not swept.
bool is_worth_merging(double columns, double zeros, double entries) {
  constexpr double kMostColumns[3] = {4, 12, 32};      // nodes
  constexpr double kMostZeros[3] = {0.6, 0.25, 0.08};  // share of the entries
  if (zeros == 0) return true;
  for (int k = 0; k < 3; ++k)
    if (columns <= kMostColumns[k] && zeros <= kMostZeros[k] * entries) return true;
  return zeros <= 0.02 * entries;
}

// The same with the last `border` columns in one line above all others.
void lead_to_border(std::vector<int>& parent, int border) {
  const int size = static_cast<int>(parent.size()), inner = size - border;
  if (border == 0) return;
  for (int j = 0; j < inner; ++j) parent[j] = std::min(parent[j], inner);
  for (int j = inner; j < size; ++j) parent[j] = j + 1 < size ? j + 1 : -1;
}

// First columns of the supernodes: columns in line whose rows differ by the diagonal alone, then merged.
std::vector<int> partition(const std::vector<int>& parent, const std::vector<int>& count, int border) {
  const int size = static_cast<int>(parent.size()), inner = size - border;
  std::vector<int> first;
  for (int j = 0; j < inner; ++j)
    if (j == 0 || parent[j - 1] != j || count[j - 1] != count[j] + 1) first.push_back(j);
  // From the last on, each with the one behind it when that is its parent.
  struct Group {
    int first, last, below;  // columns; rows below
    double zeros;
  };
  std::vector<Group> groups;  // the last one is the first in the order
  if (border > 0) groups.push_back({inner, size - 1, 0, 0});
  for (int s = static_cast<int>(first.size()) - 1; s >= 0; --s) {
    const int last = (s + 1 < static_cast<int>(first.size()) ? first[s + 1] : inner) - 1;
    Group group{first[s], last, count[last] - 1, 0};
    while (!groups.empty() && parent[group.last] == groups.back().first && groups.back().first < inner) {
      const Group& next = groups.back();
      const double own = group.last - group.first + 1, all = next.last - group.first + 1;
      const double entries = trapezoid(all, next.below);
      const double zeros = entries - (trapezoid(own, group.below) - group.zeros) -
                           (trapezoid(all - own, next.below) - next.zeros);
      if (!is_worth_merging(all, zeros, entries)) break;
      group = {group.first, next.last, next.below, zeros};
      groups.pop_back();
    }
    groups.push_back(group);
  }
  std::vector<int> result;
  for (auto group = groups.rbegin(); group != groups.rend(); ++group) result.push_back(group->first);
  result.push_back(size);
  return result;
}

// For each column the neighbours that come after it.
Lists later_neighbours(const Lists& earlier) {
  const int size = static_cast<int>(earlier.start.size()) - 1;
  Lists lists;
  lists.start.assign(size + 1, 0);
  for (const int j : earlier.entry) ++lists.start[j + 1];
  std::partial_sum(lists.start.begin(), lists.start.end(), lists.start.begin());
  lists.entry.resize(earlier.entry.size());
  std::vector<int> next(lists.start.begin(), lists.start.end() - 1);
  for (int i = 0; i < size; ++i)
    for (int k = earlier.start[i]; k < earlier.start[i + 1]; ++k) lists.entry[next[earlier.entry[k]]++] = i;
  return lists;
}

// Rows of each supernode below its columns: those of its own entries and of its children.
void find_rows(Supernodes& nodes, const Lists& later) {
  const int count = static_cast<int>(nodes.first.size()) - 1;
  std::vector<int> mark(nodes.order.size(), -1), supernode(nodes.order.size());
  for (int s = 0; s < count; ++s)
    for (int j = nodes.first[s]; j < nodes.first[s + 1]; ++j) supernode[j] = s;
  std::vector<std::vector<int>> children(count);
  nodes.parent.assign(count, -1);
  nodes.child.reserve(count);
  for (int s = 0; s < count; ++s) {
    const int end = nodes.first[s + 1];
    const auto take = [&](int row) {
      if (row < end || mark[row] == s) return;
      mark[row] = s;
      nodes.rows.push_back(row);
    };
    for (int j = nodes.first[s]; j < end; ++j)
      for (int k = later.start[j]; k < later.start[j + 1]; ++k) take(later.entry[k]);
    for (const int child : children[s])
      for (int k = nodes.below[child]; k < nodes.below[child + 1]; ++k) take(nodes.rows[k]);
    nodes.child.insert(nodes.child.end(), children[s].begin(), children[s].end());
    nodes.child_start.push_back(static_cast<int>(nodes.child.size()));
    std::sort(nodes.rows.begin() + nodes.below[s], nodes.rows.end());
    nodes.below.push_back(static_cast<int>(nodes.rows.size()));
    if (nodes.below[s] == nodes.below[s + 1]) continue;
    nodes.parent[s] = supernode[nodes.rows[nodes.below[s]]];
    children[nodes.parent[s]].push_back(s);
  }
}

// Where each row stands in the front of the parent.
void find_places(Supernodes& nodes) {
  nodes.place.resize(nodes.rows.size());
  for (int s = 0; s < nodes.size(); ++s) {
    const int parent = nodes.parent[s];
    if (parent < 0) continue;
    int at = nodes.below[parent];
    for (int k = nodes.below[s]; k < nodes.below[s + 1]; ++k) {
      const int row = nodes.rows[k];
      if (row < nodes.first[parent + 1]) {
        nodes.place[k] = row - nodes.first[parent];
        continue;
      }
      while (nodes.rows[at] != row) ++at;
      nodes.place[k] = nodes.columns(parent) + at - nodes.below[parent];
    }
  }
}

}  // namespace

bool EliminationOrder::is_consistent() const {
  const int count = static_cast<int>(order.size());
  std::vector<char> is_there(order.size(), 0);
  for (const int node : order)
    if (node < 0 || node >= count || std::exchange(is_there[node], 1)) return false;
  if (first.size() != parent.size() + 1 || first.front() != 0 || first.back() != count) return false;
  for (int s = 0; s < size(); ++s)
    if (first[s] >= first[s + 1] || (parent[s] != -1 && (parent[s] <= s || parent[s] >= size())))
      return false;
  return true;
}

double Supernodes::entries() const {
  double entries = 0;
  for (int s = 0; s < size(); ++s) entries += static_cast<double>(columns(s)) * (columns(s) + rows_below(s));
  return entries;
}

Supernodes supernodes_of(const NodeGraph& graph, const std::vector<int>& order, int border) {
  Supernodes nodes;
  std::vector<int> tree = elimination_tree(earlier_neighbours(graph, order));
  lead_to_border(tree, border);
  const std::vector<int> post = postorder(tree);
  nodes.order.resize(order.size());
  for (size_t k = 0; k < order.size(); ++k) nodes.order[k] = order[post[k]];
  const Lists earlier = earlier_neighbours(graph, nodes.order);
  const std::vector<int> parent = elimination_tree(earlier);
  nodes.first = partition(parent, column_counts(earlier, parent), border);
  find_rows(nodes, later_neighbours(earlier));
  find_places(nodes);
  return nodes;
}

}  // namespace coapt
