// First and second derivatives of a scalar function of node positions by nested automatic
// differentiation: exact to round-off and independent of any formula of ours.
#pragma once

#include "core/types.hpp"

#include <Eigen/Dense>

#include <array>
#include <cmath>
#include <unsupported/Eigen/AutoDiff>
#include <vector>

namespace coapt {

using AutoInner = Eigen::AutoDiffScalar<Eigen::Matrix<double, 1, 1>>;
using AutoSecond = Eigen::AutoDiffScalar<Eigen::Matrix<AutoInner, 1, 1>>;

// A point with coordinates of any scalar. Plain functions with explicit results keep expression
// templates of the nested scalars out of the formulas.
template <typename T>
using AutoVec = std::array<T, 3>;

template <typename T>
AutoVec<T> operator-(const AutoVec<T>& a, const AutoVec<T>& b) {
  return {T(a[0] - b[0]), T(a[1] - b[1]), T(a[2] - b[2])};
}
template <typename T>
T dot(const AutoVec<T>& a, const AutoVec<T>& b) {
  const T xx = a[0] * b[0], yy = a[1] * b[1], zz = a[2] * b[2];
  return T(T(xx + yy) + zz);
}
template <typename T>
AutoVec<T> cross(const AutoVec<T>& a, const AutoVec<T>& b) {
  const auto entry = [](const T& p, const T& q, const T& r, const T& s) {
    const T pq = p * q, rs = r * s;
    return T(pq - rs);
  };
  return {entry(a[1], b[2], a[2], b[1]), entry(a[2], b[0], a[0], b[2]), entry(a[0], b[1], a[1], b[0])};
}
template <typename T>
T norm(const AutoVec<T>& a) {
  using std::sqrt;
  const T square = dot(a, a);
  return T(sqrt(square));
}
template <typename T>
T times(double factor, const T& a) {
  return T(T(factor) * a);
}
template <typename T>
double number(const T& a) {
  if constexpr (std::is_same_v<T, double>)
    return a;
  else
    return number(a.value());
}

struct SecondOrder {
  double value = 0;
  Vector gradient;
  Eigen::MatrixXd hessian;
};

// All second derivatives, one pair of coordinates at a time: slow, and simple enough to be believed.
template <typename Energy>
SecondOrder differentiate_twice(const Energy& energy, const Points& x) {
  const Eigen::Index n = x.size();
  SecondOrder result;
  result.gradient.resize(n);
  result.hessian.resize(n, n);
  std::vector<AutoVec<AutoSecond>> y(static_cast<size_t>(x.cols()));
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      for (Eigen::Index k = 0; k < n; ++k) {
        AutoInner inner(x.data()[k]);
        inner.derivatives()[0] = k == j ? 1 : 0;
        AutoInner outer(k == i ? 1.0 : 0.0);
        outer.derivatives()[0] = 0;
        AutoSecond& coordinate = y[k / 3][k % 3];
        coordinate.value() = inner;
        coordinate.derivatives()[0] = outer;
      }
      const AutoSecond w = energy(y);
      result.value = w.value().value();
      result.gradient[i] = w.derivatives()[0].value();
      result.hessian(i, j) = result.hessian(j, i) = w.derivatives()[0].derivatives()[0];
    }
  return result;
}

}  // namespace coapt
