#include "mesh/closed_view.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace coapt {
namespace {

// For each node the node of greatest value in the window along rows, then along columns.
class Windows {
 public:
  Windows(const TopView& view, int radius) : view_(view), radius_(radius) {}

  std::vector<int> highest(const std::vector<double>& value) {
    std::vector<int> source(value.size());
    std::iota(source.begin(), source.end(), 0);
    for (int j = 0; j < view_.rows; ++j) slide(value, source, j * view_.columns, 1, view_.columns);
    for (int i = 0; i < view_.columns; ++i) slide(value, source, i, view_.columns, view_.rows);
    return source;
  }

 private:
  // One line of nodes: first, first + step, ... Replaces the source of each by the best in its window.
  void slide(const std::vector<double>& value, std::vector<int>& source, int first, int step, int count) {
    const auto node = [&](int k) { return static_cast<size_t>(first + k * step); };
    const auto value_at = [&](int k) { return value[static_cast<size_t>(line_[static_cast<size_t>(k)])]; };
    line_.resize(static_cast<size_t>(count));
    for (int k = 0; k < count; ++k) line_[static_cast<size_t>(k)] = source[node(k)];
    queue_.clear();
    size_t head = 0;
    for (int k = 0, entered = 0; k < count; ++k) {
      for (; entered <= std::min(k + radius_, count - 1); ++entered) {
        while (queue_.size() > head && value_at(queue_.back()) < value_at(entered)) queue_.pop_back();
        queue_.push_back(entered);
      }
      while (queue_[head] < k - radius_) ++head;
      source[node(k)] = line_[static_cast<size_t>(queue_[head])];
    }
  }

  const TopView& view_;
  int radius_;
  std::vector<int> line_, queue_;
};

// See ClosedView::source.
std::vector<int> rims(const TopView& view, const std::vector<double>& closed_height, double depth) {
  std::vector<int> source(view.height.size(), -1), reached;
  for (size_t n = 0; n < source.size(); ++n) {
    if (view.triangle[n] < 0 || view.height[n] < closed_height[n] - depth) continue;
    source[n] = static_cast<int>(n);
    reached.push_back(source[n]);
  }
  for (size_t k = 0; k < reached.size(); ++k) {
    const int node = reached[k], i = node % view.columns, j = node / view.columns;
    const auto reach = [&](bool is_there, int next) {
      if (!is_there || source[static_cast<size_t>(next)] >= 0) return;
      if (!std::isfinite(closed_height[static_cast<size_t>(next)])) return;
      source[static_cast<size_t>(next)] = source[static_cast<size_t>(node)];
      reached.push_back(next);
    };
    reach(i > 0, node - 1);
    reach(i + 1 < view.columns, node + 1);
    reach(j > 0, node - view.columns);
    reach(j + 1 < view.rows, node + view.columns);
  }
  return source;
}

}  // namespace

ClosedView closed_view(const TopView& view, int radius) {
  Windows windows(view, radius);
  const std::vector<int> highest = windows.highest(view.height);
  std::vector<double> negative(highest.size());
  for (size_t n = 0; n < negative.size(); ++n) negative[n] = -view.height[static_cast<size_t>(highest[n])];
  const std::vector<int> lowest = windows.highest(negative);
  ClosedView closed;
  for (const int n : lowest) closed.height.push_back(-negative[static_cast<size_t>(n)]);
  closed.source = rims(view, closed.height, 2 * radius * view.cell);
  return closed;
}

std::vector<char> near_marked(const TopView& view, const std::vector<char>& marked, int radius) {
  const std::vector<int> source =
      Windows(view, radius).highest(std::vector<double>(marked.begin(), marked.end()));
  std::vector<char> near(marked.size());
  for (size_t n = 0; n < near.size(); ++n) near[n] = marked[static_cast<size_t>(source[n])];
  return near;
}

}  // namespace coapt
