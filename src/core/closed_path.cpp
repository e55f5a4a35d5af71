#include "core/closed_path.hpp"

#include "core/types.hpp"

#include <algorithm>
#include <cstdlib>

namespace coapt {
namespace {

struct PathTable {
  Eigen::MatrixXd least;  // of all paths from the start to a state of a column
  Eigen::MatrixXi from;   // state of the column before
};

// Fills the table for paths that begin in one state of the first column.
void fill(PathTable& table, const Eigen::MatrixXd& costs, int start, int greatest_step, double step_cost) {
  const int states = static_cast<int>(costs.rows()), columns = static_cast<int>(costs.cols());
  table.least.col(0).setConstant(kInfinity);
  table.least(start, 0) = costs(start, 0);
  for (int column = 1; column < columns; ++column)
    for (int state = 0; state < states; ++state) {
      double least = kInfinity;
      int from = state;
      const int first = std::max(state - greatest_step, 0),
                last = std::min(state + greatest_step, states - 1);
      for (int other = first; other <= last; ++other) {
        const double cost = table.least(other, column - 1) + step_cost * std::abs(other - state);
        if (cost < least) {
          least = cost;
          from = other;
        }
      }
      table.least(state, column) = least + costs(state, column);
      table.from(state, column) = from;
    }
}

}  // namespace

std::vector<int> closed_path(const Eigen::MatrixXd& costs, int greatest_step, double step_cost) {
  const int states = static_cast<int>(costs.rows()), columns = static_cast<int>(costs.cols());
  PathTable table{Eigen::MatrixXd(states, columns), Eigen::MatrixXi::Zero(states, columns)};
  std::vector<int> best(static_cast<size_t>(columns), 0);
  double best_cost = kInfinity;
  for (int start = 0; start < states; ++start) {
    fill(table, costs, start, greatest_step, step_cost);
    const int first = std::max(start - greatest_step, 0), last = std::min(start + greatest_step, states - 1);
    for (int end = first; end <= last; ++end) {
      const double cost = table.least(end, columns - 1) + step_cost * std::abs(end - start);
      if (cost >= best_cost) continue;
      best_cost = cost;
      int state = end;
      for (int column = columns - 1; column >= 0; --column) {
        best[static_cast<size_t>(column)] = state;
        state = table.from(state, column);
      }
    }
  }
  return best;
}

}  // namespace coapt
