#include "optim/linear/multifrontal_factor.hpp"

#include <algorithm>
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
  values_.resize(panel_.back());
  column_.resize(static_cast<size_t>(most) + 3);
  plan_ = plan_updates(nodes_);
  for (int k = 0; k < 2; ++k) stack_[k].resize(plan_.size[k]);
  place_blocks(graph);
}

bool MultifrontalFactor::factorise(const double* values) {
  for (int s = 0; s < eliminated_; ++s) {
    const DenseFront front = assembled_front(s, values);
    if (!eliminate_positive_definite(front)) return false;
    add_updates(s, front, Part::Below);
  }
  if (eliminated_ < nodes_.size()) assembled_front(eliminated_, values);
  return measure_pivots();
}

void MultifrontalFactor::count_signs(const double* values, int& negative, int& positive) {
  for (int s = 0; s < nodes_.size(); ++s) {
    const DenseFront front = assembled_front(s, values);
    if (!eliminate_indefinite(front, scaled_, negative, positive)) return;
    add_updates(s, front, Part::Below);
  }
}

MultifrontalFactor::UpdatePlan MultifrontalFactor::plan_updates(const Supernodes& nodes) {
  const int count = nodes.size();
  UpdatePlan plan{std::vector<size_t>(count), std::vector<int>(count, 0), {0, 0}};
  for (int s = count - 1; s >= 0; --s)
    if (nodes.parent[s] >= 0) plan.parity[s] = 1 - plan.parity[nodes.parent[s]];
  size_t top[2] = {0, 0};
  for (int s = 0; s < count; ++s) {
    const int own = plan.parity[s];
    plan.place[s] = top[own];
    top[own] += update_size(3 * nodes.rows_below(s));
    plan.size[own] = std::max(plan.size[own], top[own]);
    if (nodes.child_start[s] < nodes.child_start[s + 1])
      top[1 - own] = plan.place[nodes.child[nodes.child_start[s]]];
  }
  return plan;
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
DenseFront MultifrontalFactor::assembled_front(int s, const double* source) {
  const DenseFront front = front_of(s);
  std::fill(values_.begin() + static_cast<std::ptrdiff_t>(panel_[s]),
            values_.begin() + static_cast<std::ptrdiff_t>(panel_[s + 1]), 0.0);
  for (int k = first_move_[s]; k < first_move_[s + 1]; ++k) {
    const BlockMove& move = moves_[k];
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r)
        front.panel[move.to + r + c * front.panel_stride()] =
            source[move.from + r * move.row_step + c * move.column_step];
  }
  add_updates(s, front, Part::Columns);
  return front;
}

void MultifrontalFactor::add_updates(int s, const DenseFront& front, Part part) {
  for (int k = nodes_.child_start[s]; k < nodes_.child_start[s + 1]; ++k) {
    const int child = nodes_.child[k], rows = nodes_.rows_below(child);
    const int* place = nodes_.place.data() + nodes_.below[child];
    const int split = static_cast<int>(std::lower_bound(place, place + rows, nodes_.columns(s)) - place);
    if (part == Part::Columns)
      add_columns(child, 0, split, 0, front.panel, front.panel_stride());
    else
      add_columns(child, split, rows, nodes_.columns(s), front.update, front.update_stride());
  }
}

// Columns first ... last - 1 of a child's update; target: the part of the parent's front that begins at
// place `begin`.
void MultifrontalFactor::add_columns(int child, int first, int last, int begin, double* target, int stride) {
  const int rows = nodes_.rows_below(child), own_stride = DenseFront::stride(3 * rows);
  const int* place = nodes_.place.data() + nodes_.below[child];
  for (int j = first; j < last; ++j)
    for (int c = 0; c < 3; ++c) {
      const double* from = update_of(child) + static_cast<std::ptrdiff_t>(3 * j + c) * own_stride;
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

void MultifrontalFactor::solve_forward(Vector& x) {
  for (int s = 0; s < eliminated_; ++s) {
    const DenseFront front = front_of(s);
    std::copy_n(x.data() + 3 * nodes_.first[s], front.columns, column_.data());
    std::fill_n(column_.data() + front.columns, front.below + 3, 0.0);
    solve_columns_forward(front, column_.data());
    std::copy_n(column_.data(), front.columns, x.data() + 3 * nodes_.first[s]);
    const double* below = column_.data() + front.columns;
    for (int k = nodes_.below[s]; k < nodes_.below[s + 1]; ++k, below += 3)
      for (int c = 0; c < 3; ++c) x[3 * nodes_.rows[k] + c] += below[c];
  }
}

void MultifrontalFactor::solve_backward(Vector& x) {
  for (int s = eliminated_ - 1; s >= 0; --s) {
    const DenseFront front = front_of(s);
    std::copy_n(x.data() + 3 * nodes_.first[s], front.columns, column_.data());
    double* below = column_.data() + front.columns;
    for (int k = nodes_.below[s]; k < nodes_.below[s + 1]; ++k, below += 3)
      for (int c = 0; c < 3; ++c) below[c] = x[3 * nodes_.rows[k] + c];
    std::fill_n(below, 3, 0.0);
    solve_columns_backward(front, column_.data());
    std::copy_n(column_.data(), front.columns, x.data() + 3 * nodes_.first[s]);
  }
}

// False when a pivot is not a number.
bool MultifrontalFactor::measure_pivots() {
  double least = kInfinity, greatest = 0;
  for (int s = 0; s < eliminated_; ++s)
    for (int c = 0; c < 3 * nodes_.columns(s); ++c) {
      const double pivot = values_[panel_[s] + static_cast<size_t>(c) * static_cast<size_t>(stride(s) + 1)];
      if (!std::isfinite(pivot)) return false;
      least = std::min(least, pivot);
      greatest = std::max(greatest, pivot);
    }
  pivot_ratio_ = eliminated_ == 0 ? 1 : (least / greatest) * (least / greatest);
  return true;
}

}  // namespace coapt
