// The inverse of a shifted tangent with a skew part, applied to vectors.
#pragma once

#include "linear/bordered_factor.hpp"
#include "linear/free_directions.hpp"

#include <Eigen/SparseLU>

#include <optional>

namespace coapt {

class InverseTangent {
 public:
  // Of K + W + shift, where K + shift is positive definite. lower: K as Factorisation wants it. start: with
  // no zero where W couples. Where W couples few nodes they are eliminated last, which takes a tenth of the
  // time of a sparse L U. team: may share that work.
  InverseTangent(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start, double shift,
                 const std::shared_ptr<ThreadTeam>& team);

  bool is_made() const { return is_made_; }
  Eigen::MatrixXd times(const Eigen::MatrixXd& block);

 private:
  // Minimum degree on the pattern, which is symmetric: half the fill that an ordering of columns leaves.
  struct SymmetricOrdering {
    template <class Matrix>
    void operator()(const Matrix& matrix,
                    Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>& order) {
      Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> inverse;
      Eigen::AMDOrdering<int>()(matrix, inverse);  // SparseLU wants the other direction
      order = inverse.inverse();
    }
  };

  bool is_made_ = false;
  std::optional<BorderedFactor> bordered_;
  std::optional<Eigen::SparseLU<SparseMatrix, SymmetricOrdering>> sparse_;
};

}  // namespace coapt
