#include "linear/krylov_basis.hpp"

namespace coapt {
namespace {

constexpr double kDependent = 1e-10;  // length that is left of a vector, over what it had: round-off
constexpr double kShrunk = 0.1;       // the same beside its own block: once more against all

// Takes away what lies along orthonormal vectors. Once leaves round-off of what was taken, twice does not.
template <class Vectors, class Block>
void remove(const Vectors& vectors, Block&& block) {
  block.noalias() -= vectors * (vectors.transpose() * block).eval();
}

}  // namespace

Eigen::Index KrylovBasis::append(Eigen::MatrixXd block) {
  if (count_ + block.cols() > columns_.cols())
    columns_.conservativeResize(Eigen::NoChange, 2 * (columns_.cols() + block.cols()));
  first_of_last_ = count_;
  const Eigen::VectorXd lengths = block.colwise().norm().transpose();
  const auto before = columns_.leftCols(count_);
  remove(before, block);
  remove(before, block);
  for (Eigen::Index k = 0; k < block.cols(); ++k) {
    auto column = block.col(k);
    const double beside_others = column.norm();
    remove(last(), column);
    remove(last(), column);
    if (column.norm() < kShrunk * beside_others)
      remove(vectors(), column);  // round-off of the others has grown
    const double length = column.norm();
    if (length > kDependent * lengths[k]) columns_.col(count_++) = column / length;
  }
  return count_ - first_of_last_;
}

}  // namespace coapt
