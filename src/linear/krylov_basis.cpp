#include "linear/krylov_basis.hpp"

namespace coapt {
namespace {

constexpr double kDependent = 1e-10;  // length that is left of a vector, over what it had: round-off

}  // namespace

void KrylovBasis::append(Eigen::MatrixXd block) {
  if (count_ + block.cols() > columns_.cols())
    columns_.conservativeResize(Eigen::NoChange, 2 * (columns_.cols() + block.cols()));
  first_of_last_ = count_;
  const Eigen::VectorXd lengths = block.colwise().norm().transpose();
  const auto before = columns_.leftCols(count_);
  for (int pass = 0; pass < 2; ++pass)  // twice is enough: Giraud, Langou and Rozloznik (2005)
    block.noalias() -= before * (before.transpose() * block).eval();
  for (Eigen::Index k = 0; k < block.cols(); ++k) {
    auto column = block.col(k);
    for (int pass = 0; pass < 2; ++pass) {
      const auto new_ones = last();
      column.noalias() -= new_ones * (new_ones.transpose() * column).eval();
    }
    const double length = column.norm();
    if (length > kDependent * lengths[k]) columns_.col(count_++) = column / length;
  }
}

}  // namespace coapt
