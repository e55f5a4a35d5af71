// A factor of K + W, where K is symmetric and W couples few nodes alone: the rim of a surface under follower
// pressure. These are eliminated last, by L U of their Schur complement; all others by Cholesky.
#pragma once

#include "linear/factorisation.hpp"
#include "linear/multifrontal_factor.hpp"
#include "linear/updated_order.hpp"

#include <Eigen/LU>

#include <vector>

namespace coapt {

class BorderedFactor {
 public:
  // As MultifrontalFactor::use_threads().
  void use_threads(std::shared_ptr<ThreadTeam> team) { factor_.use_threads(std::move(team)); }

  // lower: the pattern of K, as Factorisation has it. border: the nodes that W couples.
  void analyse(const SparseMatrix& lower, const std::vector<int>& border);

  // border_part: W between the coordinates of the border's nodes, in their order. False where K is not
  // positive definite on the other nodes, or the Schur complement is not finite.
  bool factorise(const SparseMatrix& lower, const Eigen::MatrixXd& border_part);

  // Negative eigenvalues of K, by the pivots of L D L^T of the symmetric part of its Schur complement without
  // pivoting; -1 where one is zero. Pre: factorise() returned true.
  int negative_eigenvalues();

  // x = (K + W)^-1 b, or (K + W)^-T b. Pre: factorise() returned true.
  void solve(const Vector& b, Vector& x) { solve(b, x, false); }
  void solve_transposed(const Vector& b, Vector& x) { solve(b, x, true); }

 private:
  void solve(const Vector& b, Vector& x, bool is_transposed);

  MultifrontalFactor factor_;
  KeptOrder kept_;
  std::vector<int> border_;
  Eigen::PartialPivLU<Eigen::MatrixXd> schur_;
  Vector work_;
  std::vector<double> front_, scaled_;  // a Schur complement eliminated, to count signs
};

}  // namespace coapt
