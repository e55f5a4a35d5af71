// GMRES (Saad & Schultz 1986) for a system that a factorisation solves but for a small remainder.
#pragma once

#include "core/types.hpp"

#include <functional>

namespace coapt {

// Solves x + B x = b, where applying B costs about one back-substitution, in a Krylov space that is kept
// between calls: nothing is allocated after the first call for a size.
class Gmres {
 public:
  explicit Gmres(int max_vectors) : max_vectors_(max_vectors) {}

  // apply: out = B v. On return the residual |b - x - B x| <= tolerance |b|, or the space is exhausted.
  // Returns the number of applications.
  int solve(const std::function<void(const Vector& v, Vector& out)>& apply, const Vector& b, double tolerance,
            Vector& x);

 private:
  int max_vectors_;
  Eigen::MatrixXd basis_;       // orthonormal columns
  Eigen::MatrixXd hessenberg_;  // upper triangle after the rotations
  Vector cosine_, sine_, rotated_, product_, direction_;
};

}  // namespace coapt
