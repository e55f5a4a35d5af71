// GMRES (Saad & Schultz 1986) for a system that a factorisation solves but for a small remainder.
#pragma once

#include "core/types.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace coapt {

// Solves x + B x = b, where applying B costs about one back-substitution, in a Krylov space that is kept
// between calls: nothing is allocated after the first call for a size.
class Gmres {
 public:
  explicit Gmres(int max_vectors) : max_vectors_(max_vectors) {}

  // apply(v, out): out = B v. On return the residual |b - x - B x| <= tolerance |b|, or the space is
  // exhausted, or B was applied `most` times. Returns the number of applications.
  template <typename Apply>
  int solve(const Apply& apply, const Vector& b, double tolerance, Vector& x,
            int most = std::numeric_limits<int>::max());

  // Of the last solution, relative to |b|.
  double residual() const { return residual_; }

 private:
  int max_vectors_;
  Eigen::MatrixXd basis_;       // orthonormal columns
  Eigen::MatrixXd hessenberg_;  // upper triangle after the rotations
  Vector cosine_, sine_, rotated_, product_, direction_;
  double residual_ = 0;
};

template <typename Apply>
int Gmres::solve(const Apply& apply, const Vector& b, double tolerance, Vector& x, int most) {
  const int m = max_vectors_;
  basis_.resize(b.size(), m + 1);
  hessenberg_.resize(m + 1, m);
  cosine_.resize(m);
  sine_.resize(m);
  rotated_.setZero(m + 1);
  product_.resize(b.size());
  direction_.resize(b.size());

  const double norm = b.norm();
  x = b;
  residual_ = 0;
  if (norm == 0) return 0;
  basis_.col(0) = b / norm;
  rotated_[0] = norm;
  int used = 0;
  while (used < std::min(m, most) && std::abs(rotated_[used]) > tolerance * norm) {
    const int j = used++;
    direction_ = basis_.col(j);
    apply(direction_, product_);
    product_ += direction_;
    for (int i = 0; i <= j; ++i) {  // modified Gram-Schmidt
      hessenberg_(i, j) = basis_.col(i).dot(product_);
      product_ -= hessenberg_(i, j) * basis_.col(i);
    }
    const double rest = product_.norm();
    for (int i = 0; i < j; ++i) {
      const double upper = hessenberg_(i, j), lower = hessenberg_(i + 1, j);
      hessenberg_(i, j) = cosine_[i] * upper + sine_[i] * lower;
      hessenberg_(i + 1, j) = cosine_[i] * lower - sine_[i] * upper;
    }
    const double length = std::hypot(hessenberg_(j, j), rest);
    cosine_[j] = hessenberg_(j, j) / length;
    sine_[j] = rest / length;
    hessenberg_(j, j) = length;
    rotated_[j + 1] = -sine_[j] * rotated_[j];
    rotated_[j] *= cosine_[j];
    if (rest <= 1e-14 * length) break;  // the space holds the solution
    basis_.col(j + 1) = product_ / rest;
  }
  residual_ = std::abs(rotated_[used]) / norm;
  x.setZero();
  for (int j = used - 1; j >= 0; --j) {  // back-substitution, in place
    for (int i = j + 1; i < used; ++i) rotated_[j] -= hessenberg_(j, i) * rotated_[i];
    rotated_[j] /= hessenberg_(j, j);
  }
  for (int j = 0; j < used; ++j) x += rotated_[j] * basis_.col(j);
  return used;
}

}  // namespace coapt
