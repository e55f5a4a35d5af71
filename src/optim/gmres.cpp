#include "optim/gmres.hpp"

#include <cmath>

namespace coapt {

int Gmres::solve(const std::function<void(const Vector&, Vector&)>& apply, const Vector& b, double tolerance,
                 Vector& x) {
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
  if (norm == 0) return 0;
  basis_.col(0) = b / norm;
  rotated_[0] = norm;
  int used = 0;
  while (used < m && std::abs(rotated_[used]) > tolerance * norm) {
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
  x.setZero();
  for (int j = used - 1; j >= 0; --j) {  // back-substitution, in place
    for (int i = j + 1; i < used; ++i) rotated_[j] -= hessenberg_(j, i) * rotated_[i];
    rotated_[j] /= hessenberg_(j, j);
  }
  for (int j = 0; j < used; ++j) x += rotated_[j] * basis_.col(j);
  return used;
}

}  // namespace coapt
