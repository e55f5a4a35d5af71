#include "optim/linear/bordered_factor.hpp"

#include "optim/linear/node_ordering.hpp"

#include <algorithm>

namespace coapt {

void BorderedFactor::analyse(const SparseMatrix& lower, const std::vector<int>& border) {
  const NodeGraph graph = node_graph(lower);
  std::vector<int> order = node_order(graph);
  std::vector<char> is_border(order.size(), 0);
  for (const int node : border) is_border[node] = 1;
  order.erase(std::remove_if(order.begin(), order.end(), [&](int node) { return is_border[node] != 0; }),
              order.end());
  order.insert(order.end(), border.begin(), border.end());
  const auto count = static_cast<int>(border.size());
  factor_.analyse(graph, supernodes_of(graph, order, count), count);
}

bool BorderedFactor::factorise(const SparseMatrix& lower, const Eigen::MatrixXd& border_part) {
  if (!factor_.factorise(lower.valuePtr())) return false;
  if (border_part.size() == 0) return true;
  Eigen::MatrixXd schur = factor_.schur_complement().selfadjointView<Eigen::Lower>();
  schur += border_part;
  if (!schur.allFinite()) return false;
  schur_.compute(schur);
  return schur_.matrixLU().diagonal().array().isFinite().all() &&
         (schur_.matrixLU().diagonal().array() != 0).all();
}

void BorderedFactor::solve(const Vector& b, Vector& x) {
  factor_.permute(b, work_);
  factor_.solve_forward(work_);
  if (auto border = work_.tail(schur_.rows()); border.size() > 0) border = schur_.solve(border).eval();
  factor_.solve_backward(work_);
  factor_.restore(work_, x);
}

}  // namespace coapt
