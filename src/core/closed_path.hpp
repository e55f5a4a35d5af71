// The cheapest closed path around a ring of columns.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace coapt {

// One state for each column: the sum of costs(state, column), and of step_cost for each state that neighbours
// differ by, is least; the last column is a neighbour of the first, and no two neighbours differ by more than
// greatest_step. The exact minimum: every state of the first column is tried (dynamic programming, Bellman
// 1957). O(columns states^2 greatest_step). Pre: costs is not empty and finite, greatest_step >= 0.
std::vector<int> closed_path(const Eigen::MatrixXd& costs, int greatest_step, double step_cost);

}  // namespace coapt
