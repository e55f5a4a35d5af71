#include "linear/inverse_tangent.hpp"

#include "linear/skew_part.hpp"

#include <vector>

namespace coapt {
namespace {

// K + W + shift. W is not given by its entries: it is applied to each unknown that it couples.
SparseMatrix whole_tangent(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start,
                           double shift) {
  const Eigen::Index size = lower.cols();
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(2 * static_cast<size_t>(lower.nonZeros()));
  for (int column = 0; column < size; ++column)
    for (SparseMatrix::InnerIterator entry(lower, column); entry; ++entry) {
      if (entry.row() < column) continue;
      const double added = entry.row() == column ? shift : 0;
      entries.emplace_back(entry.row(), column, entry.value() + added);
      if (entry.row() > column) entries.emplace_back(column, entry.row(), entry.value());
    }
  Vector coupled = Vector::Zero(size), unit = coupled, product(size);
  skew(start, coupled);
  for (int column = 0; column < size; ++column) {
    if (coupled[column] == 0) continue;
    unit[column] = 1;
    product.setZero();
    skew(unit, product);
    unit[column] = 0;
    for (int row = 0; row < size; ++row)
      if (product[row] != 0) entries.emplace_back(row, column, product[row]);
  }
  SparseMatrix whole(size, size);
  whole.setFromTriplets(entries.begin(), entries.end());
  return whole;
}

}  // namespace

InverseTangent::InverseTangent(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start,
                               double shift, const std::shared_ptr<ThreadTeam>& team) {
  const std::vector<int> border = coupled_nodes(skew, start);
  if (border.size() <= kMostBorder) {
    SparseMatrix shifted = lower;
    shifted.diagonal().array() += shift;
    bordered_.emplace();
    bordered_->use_threads(team);
    bordered_->analyse(shifted, border);
    is_made_ = bordered_->factorise(shifted, skew_entries(skew, border, lower.cols()));
    return;
  }
  sparse_.emplace();
  sparse_->isSymmetric(true);
  sparse_->setPivotThreshold(0);  // K + shift is positive definite, so that the diagonal gives the pivots
  sparse_->compute(whole_tangent(lower, skew, start, shift));
  is_made_ = sparse_->info() == Eigen::Success;
}

Eigen::MatrixXd InverseTangent::times(const Eigen::MatrixXd& block) {
  if (sparse_) return sparse_->solve(block);
  Eigen::MatrixXd result(block.rows(), block.cols());
  Vector in, out;
  for (Eigen::Index k = 0; k < block.cols(); ++k) {
    in = block.col(k);
    bordered_->solve(in, out);
    result.col(k) = out;
  }
  return result;
}

}  // namespace coapt
