#include "linear/multifrontal_factor.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace coapt {
namespace {

size_t update_size(int rows) {
  return static_cast<size_t>(rows) * static_cast<size_t>(DenseFront::stride(rows));
}

}  // namespace

void MultifrontalFactor::analyse(const NodeGraph& graph, Supernodes nodes, int border) {
  nodes_ = std::move(nodes);
  eliminated_ = nodes_.size() - (border > 0 ? 1 : 0);
  panel_.assign(1, 0);
  int most = 0;
  for (int s = 0; s < nodes_.size(); ++s) {
    panel_.push_back(panel_.back() +
                     static_cast<size_t>(3 * nodes_.columns(s)) * static_cast<size_t>(stride(s)));
    most = std::max(most, height(s));
  }
  values_.need(panel_.back());
  passed_.need(3 * nodes_.rows.size());
  part_tree();
  plan_updates();
  kept_.need(plan_.size[2]);
  workspaces_.resize(is_shared() ? static_cast<size_t>(team_->size()) : 1);
  for (Workspace& own : workspaces_) {
    for (int k = 0; k < 2; ++k) own.stack[k].need(plan_.size[k]);
    own.column.need(static_cast<size_t>(most) + 3);
  }
  place_blocks(graph);
}

// Cuts off subtrees that are each worth at most a share of all work: so many that threads end together, and
// the same ones whatever their number.
void MultifrontalFactor::part_tree() {
  constexpr double kShares = 16;  // of all work: for up to eight threads
  std::vector<double> work(static_cast<size_t>(nodes_.size()), 0);
  std::vector<int> first(static_cast<size_t>(nodes_.size()));  // of each subtree
  work_ = 0;
  for (int s = 0; s < nodes_.size(); ++s) {
    const double columns = 3 * nodes_.columns(s), below = 3 * nodes_.rows_below(s);
    const double own = columns * (columns * (columns / 6 + below / 2) + below * below / 2);
    work_ += own;
    work[s] += own;
    first[s] =
        nodes_.child_start[s] < nodes_.child_start[s + 1] ? first[nodes_.child[nodes_.child_start[s]]] : s;
    if (nodes_.parent[s] >= 0) work[nodes_.parent[s]] += work[s];
  }
  const auto is_top = [&](int s) { return s >= eliminated_ || work[s] > work_ / kShares; };
  subtrees_.clear();
  top_.clear();
  for (int s = 0; s < nodes_.size(); ++s) {
    if (is_top(s))
      top_.push_back(s);
    else if (nodes_.parent[s] < 0 || is_top(nodes_.parent[s]))
      subtrees_.emplace_back(first[s], s);
  }
  std::stable_sort(subtrees_.begin(), subtrees_.end(),
                   [&](const auto& a, const auto& b) { return work[a.second] > work[b.second]; });
}

void MultifrontalFactor::plan_updates() {
  plan_ = {std::vector<size_t>(nodes_.size()), std::vector<Home>(nodes_.size(), Home::EvenStack), {0, 0, 0}};
  for (int s = nodes_.size() - 1; s >= 0; --s)
    if (nodes_.parent[s] >= 0 && plan_.home[nodes_.parent[s]] == Home::EvenStack)
      plan_.home[s] = Home::OddStack;
  for (const auto& [first, last] : subtrees_) {
    size_t top[2] = {0, 0};
    for (int s = first; s < last; ++s) plan_update(s, top);
  }
  size_t top[2] = {0, 0};
  for (const auto& [first, last] : subtrees_) {
    plan_.home[last] = Home::Kept;
    plan_.place[last] = plan_.size[2];
    plan_.size[2] += update_size(3 * nodes_.rows_below(last));
  }
  for (const int s : top_) plan_update(s, top);
}

// top: of the two stacks. Its children's updates are taken once its own is laid down.
void MultifrontalFactor::plan_update(int s, size_t (&top)[2]) {
  const int own = plan_.home[s] == Home::OddStack ? 1 : 0;
  plan_.place[s] = top[own];
  top[own] += update_size(3 * nodes_.rows_below(s));
  plan_.size[own] = std::max(plan_.size[own], top[own]);
  for (int k = nodes_.child_start[s]; k < nodes_.child_start[s + 1]; ++k)
    if (plan_.home[nodes_.child[k]] != Home::Kept) {
      top[1 - own] = plan_.place[nodes_.child[k]];
      return;
    }
}

// visit(first, last, workspace) for each subtree, side by side.
template <class Visit>
void MultifrontalFactor::in_subtrees(const Visit& visit) {
  const auto count = static_cast<int>(subtrees_.size());
  if (is_shared()) {
    team_->run(count, [&](int k, int thread) {
      visit(subtrees_[k].first, subtrees_[k].second, workspaces_[thread]);
    });
  } else {
    for (int k = 0; k < count; ++k) visit(subtrees_[k].first, subtrees_[k].second, workspaces_[0]);
  }
}

// eliminate(s, workspace, team), children before parents; false ends it. team: what may share a front.
template <class Eliminate>
bool MultifrontalFactor::for_each_front(const Eliminate& eliminate) {
  std::atomic<bool> goes_on = true;
  in_subtrees([&](int first, int last, Workspace& own) {
    for (int s = first; s <= last && goes_on; ++s)
      if (!eliminate(s, own, nullptr)) goes_on = false;
  });
  for (const int s : top_)
    if (goes_on && s < eliminated_ && !eliminate(s, workspaces_[0], shared_team())) goes_on = false;
  return goes_on;
}

bool MultifrontalFactor::factorise(const double* values) {
  const bool is_definite = for_each_front([&](int s, Workspace& own, ThreadTeam* team) {
    const DenseFront front = assembled_front(s, values, own, team);
    if (!eliminate_positive_definite(front, team)) return false;
    add_updates(s, front, Part::Below, own, team);
    return true;
  });
  if (!is_definite) return false;
  if (eliminated_ < nodes_.size()) assembled_front(eliminated_, values, workspaces_[0], shared_team());
  return measure_pivots();
}

void MultifrontalFactor::count_signs(const double* values, int& negative, int& positive) {
  std::atomic<int> below_zero = 0, above_zero = 0;
  for_each_front([&](int s, Workspace& own, ThreadTeam* team) {
    const DenseFront front = assembled_front(s, values, own, team);
    int fewer = 0, more = 0;
    const bool goes_on = eliminate_indefinite(front, own.scaled, fewer, more);
    below_zero += fewer;
    above_zero += more;
    if (goes_on) add_updates(s, front, Part::Below, own, team);
    return goes_on;
  });
  negative += below_zero;
  positive += above_zero;
}

void MultifrontalFactor::place_blocks(const NodeGraph& graph) {
  const int count = graph.size();
  std::vector<int> place(count), supernode(count), row(count);
  for (int k = 0; k < count; ++k) place[nodes_.order[k]] = k;
  for (int s = 0; s < nodes_.size(); ++s)
    for (int k = nodes_.first[s]; k < nodes_.first[s + 1]; ++k) supernode[k] = s;
  std::vector<std::vector<std::pair<int, int>>> of_supernode(nodes_.size());  // column of the graph, entry
  for (int j = 0; j < count; ++j)
    for (int k = graph.start[j]; k < graph.start[j + 1]; ++k)
      of_supernode[supernode[std::min(place[j], place[graph.row[k]])]].emplace_back(j, k);
  moves_.clear();
  first_move_.assign(1, 0);
  moves_.reserve(graph.row.size());
  for (int s = 0; s < nodes_.size(); ++s) {
    for (int k = nodes_.below[s]; k < nodes_.below[s + 1]; ++k)
      row[nodes_.rows[k]] = nodes_.columns(s) + k - nodes_.below[s];
    for (int k = nodes_.first[s]; k < nodes_.first[s + 1]; ++k) row[k] = k - nodes_.first[s];
    for (const auto& [j, k] : of_supernode[s]) {
      const int a = place[graph.row[k]], b = place[j];
      const int step = 3 * (graph.start[j + 1] - graph.start[j]);
      const int from = 9 * graph.start[j] + 3 * (k - graph.start[j]);
      const int to = 3 * row[std::min(a, b)] * stride(s) + 3 * row[std::max(a, b)];
      moves_.push_back(a < b ? BlockMove{from, step, 1, to} : BlockMove{from, 1, step, to});
    }
    first_move_.push_back(static_cast<int>(moves_.size()));
  }
}

// The front of a supernode with its entries and, in its columns, the updates of its children. Those in its
// update matrix come once that is written.
DenseFront MultifrontalFactor::assembled_front(int s, const double* source, Workspace& own,
                                               ThreadTeam* team) {
  const DenseFront front = front_of(s, update_of(s, own));
  std::fill(values_.data() + panel_[s], values_.data() + panel_[s + 1], 0.0);
  for (int k = first_move_[s]; k < first_move_[s + 1]; ++k) {
    const BlockMove& move = moves_[k];
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        front.panel[move.to + r + c * front.panel_stride()] =
            source[move.from + r * move.row_step + c * move.column_step];
  }
  add_updates(s, front, Part::Columns, own, team);
  return front;
}

void MultifrontalFactor::add_updates(int s, const DenseFront& front, Part part, Workspace& own,
                                     ThreadTeam* team) {
  constexpr size_t kShare = 16;  // columns of nodes that a thread adds at once
  for (int k = nodes_.child_start[s]; k < nodes_.child_start[s + 1]; ++k) {
    const int child = nodes_.child[k], rows = nodes_.rows_below(child);
    const int* place = nodes_.place.data() + nodes_.below[child];
    const int split = static_cast<int>(std::lower_bound(place, place + rows, nodes_.columns(s)) - place);
    const double* update = update_of(child, own);
    const auto add = [&](int from, int to) {
      if (part == Part::Columns)
        add_columns(update, child, from, to, 0, front.panel, front.panel_stride());
      else
        add_columns(update, child, from, to, nodes_.columns(s), front.update, front.update_stride());
    };
    const int first = part == Part::Columns ? 0 : split, last = part == Part::Columns ? split : rows;
    if (team == nullptr)
      add(first, last);
    else
      team->run_ranges(static_cast<size_t>(last - first), kShare, [&](size_t from, size_t to) {
        add(first + static_cast<int>(from), first + static_cast<int>(to));
      });
  }
}

// Columns first ... last - 1 of a child's update; target: the part of the parent's front that begins at
// place `begin`.
void MultifrontalFactor::add_columns(const double* update, int child, int first, int last, int begin,
                                     double* target, int stride) {
  const int rows = nodes_.rows_below(child), own_stride = DenseFront::stride(3 * rows);
  const int* place = nodes_.place.data() + nodes_.below[child];
  for (int j = first; j < last; ++j)
    for (int c = 0; c < 3; ++c) {
      const double* from = update + static_cast<std::ptrdiff_t>(3 * j + c) * own_stride;
      double* to = target + static_cast<std::ptrdiff_t>(3 * (place[j] - begin) + c) * stride - 3 * begin;
      for (int i = j; i < rows; ++i)
        for (int r = 0; r < 3; ++r) to[3 * place[i] + r] += from[3 * i + r];
    }
}

void MultifrontalFactor::permute(const Vector& x, Vector& y) const {
  y.resize(x.size());
  for (size_t k = 0; k < nodes_.order.size(); ++k) y.segment<3>(3 * k) = x.segment<3>(3 * nodes_.order[k]);
}

void MultifrontalFactor::restore(const Vector& y, Vector& x) const {
  x.resize(y.size());
  for (size_t k = 0; k < nodes_.order.size(); ++k) x.segment<3>(3 * nodes_.order[k]) = y.segment<3>(3 * k);
}

void MultifrontalFactor::solve_front_forward(int s, Vector& x, Scratch& column) {
  const DenseFront front = front_of(s, nullptr);
  double* y = column.data();
  std::copy_n(x.data() + 3 * nodes_.first[s], front.columns, y);
  std::fill_n(y + front.columns, front.below + 3, 0.0);
  for (int k = nodes_.child_start[s]; k < nodes_.child_start[s + 1]; ++k) {
    const int child = nodes_.child[k];
    for (int row = nodes_.below[child]; row < nodes_.below[child + 1]; ++row)
      for (int c = 0; c < 3; ++c)
        y[3 * nodes_.place[row] + c] += passed_.data()[3 * static_cast<size_t>(row) + c];
  }
  if (s < eliminated_) solve_columns_forward(front, y);
  std::copy_n(y, front.columns, x.data() + 3 * nodes_.first[s]);
  std::copy_n(y + front.columns, front.below, passed_.data() + 3 * static_cast<size_t>(nodes_.below[s]));
}

void MultifrontalFactor::solve_front_backward(int s, Vector& x, Scratch& column) {
  const DenseFront front = front_of(s, nullptr);
  double* y = column.data();
  std::copy_n(x.data() + 3 * nodes_.first[s], front.columns, y);
  double* below = y + front.columns;
  for (int k = nodes_.below[s]; k < nodes_.below[s + 1]; ++k, below += 3)
    for (int c = 0; c < 3; ++c) below[c] = x[3 * nodes_.rows[k] + c];
  std::fill_n(below, 3, 0.0);
  solve_columns_backward(front, y);
  std::copy_n(y, front.columns, x.data() + 3 * nodes_.first[s]);
}

void MultifrontalFactor::solve_forward(Vector& x) {
  in_subtrees([&](int first, int last, Workspace& own) {
    for (int s = first; s <= last; ++s) solve_front_forward(s, x, own.column);
  });
  for (const int s : top_) solve_front_forward(s, x, workspaces_[0].column);
}

void MultifrontalFactor::solve_backward(Vector& x) {
  for (size_t k = top_.size(); k-- > 0;)
    if (top_[k] < eliminated_) solve_front_backward(top_[k], x, workspaces_[0].column);
  in_subtrees([&](int first, int last, Workspace& own) {
    for (int s = last; s >= first; --s) solve_front_backward(s, x, own.column);
  });
}

// False when a pivot is not a number.
bool MultifrontalFactor::measure_pivots() {
  double least = kInfinity, greatest = 0;
  for (int s = 0; s < eliminated_; ++s)
    for (int c = 0; c < 3 * nodes_.columns(s); ++c) {
      const double pivot =
          values_.data()[panel_[s] + static_cast<size_t>(c) * static_cast<size_t>(stride(s) + 1)];
      if (!std::isfinite(pivot)) return false;
      least = std::min(least, pivot);
      greatest = std::max(greatest, pivot);
    }
  pivot_ratio_ = eliminated_ == 0 ? 1 : (least / greatest) * (least / greatest);
  return true;
}

}  // namespace coapt
