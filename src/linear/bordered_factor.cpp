#include "linear/bordered_factor.hpp"

#include "linear/node_ordering.hpp"

namespace coapt {

void BorderedFactor::analyse(const SparseMatrix& lower, const std::vector<int>& border) {
  const NodeGraph graph = node_graph(lower);
  const auto border_last = [&] {
    std::vector<int> order = node_order(graph);
    std::vector<char> is_border(order.size(), 0);
    for (const int node : border) is_border[node] = 1;
    std::erase_if(order, [&](int node) { return is_border[node] != 0; });
    order.insert(order.end(), border.begin(), border.end());
    return order;
  };
  if (border != border_) kept_ = {};
  border_ = border;
  const auto count = static_cast<int>(border.size());
  factor_.analyse(graph, kept_.supernodes(graph, border_last, count), count);
}

bool BorderedFactor::factorise(const SparseMatrix& lower, const Eigen::MatrixXd& border_part) {
  if (!factor_.factorise(lower.valuePtr())) return false;
  if (border_part.size() == 0) {
    schur_ = {};
    return true;
  }
  Eigen::MatrixXd schur = factor_.schur_complement().selfadjointView<Eigen::Lower>();
  schur += border_part;
  if (!schur.allFinite()) return false;
  schur_.compute(schur);
  return schur_.matrixLU().diagonal().array().isFinite().all() &&
         (schur_.matrixLU().diagonal().array() != 0).all();
}

int BorderedFactor::negative_eigenvalues() {
  const auto size = static_cast<int>(schur_.rows());
  if (size == 0) return 0;
  const int stride = DenseFront::stride(size);
  front_.assign(static_cast<size_t>(stride) * static_cast<size_t>(size) + 3, 0.0);
  Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>(
      front_.data(), size, size, Eigen::OuterStride<>(stride)) = factor_.schur_complement();
  int negative = 0, positive = 0;
  return eliminate_indefinite({size, 0, front_.data(), nullptr}, scaled_, negative, positive) ? negative : -1;
}

void BorderedFactor::solve(const Vector& b, Vector& x, bool is_transposed) {
  factor_.permute(b, work_);
  factor_.solve_forward(work_);
  if (auto border = work_.tail(schur_.rows()); border.size() > 0)
    border = is_transposed ? Vector(schur_.transpose().solve(border)) : Vector(schur_.solve(border));
  factor_.solve_backward(work_);
  factor_.restore(work_, x);
}

}  // namespace coapt
