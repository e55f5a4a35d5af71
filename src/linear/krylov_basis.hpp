// Orthonormal vectors that span what an operator makes of a few: a block Krylov space.
#pragma once

#include "core/types.hpp"

namespace coapt {

class KrylovBasis {
 public:
  explicit KrylovBasis(Eigen::Index size) : columns_(size, kRoom) {}

  // Adds what the columns of a block, with numbers that are finite, have beside the span of those before:
  // vectors of length 1. Those of which nothing but round-off is left add none. Returns how many were added.
  Eigen::Index append(Eigen::MatrixXd block);

  Eigen::Index count() const { return count_; }
  auto vectors() const { return columns_.leftCols(count_); }
  auto last() const { return columns_.middleCols(first_of_last_, count_ - first_of_last_); }  // of append()

 private:
  static constexpr Eigen::Index kRoom = 64;  // vectors at first

  Eigen::MatrixXd columns_;
  Eigen::Index count_ = 0, first_of_last_ = 0;
};

}  // namespace coapt
