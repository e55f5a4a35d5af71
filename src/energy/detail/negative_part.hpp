// The negative part of a small symmetric matrix by its factors alone. Private to this room.
//   A = L D L^T without pivoting tells by the signs of D whether an eigenvalue is negative, and by a column
//   of L^-T a vector whose Rayleigh quotient is; from there iteration by Rayleigh quotients (Parlett 1998,
//   section 4.6) finds an eigenvalue to rounding in three or four steps. It is taken away, and so on.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace coapt {

// A = L D L^T; the factor has D on its diagonal and L below.
template <int kSize>
struct SmallFactor {
  Eigen::Matrix<double, kSize, kSize> l;
  Eigen::Vector<double, kSize> inverse_pivot;
  int negative = -1;       // a pivot that is negative
  bool is_certain = true;  // else a pivot is round-off, but not its column: nothing follows from the signs

  // Of A - shift. A pivot no greater than `least` is zero. Ends at the first that is negative if asked.
  void compute(const Eigen::Matrix<double, kSize, kSize>& a, double shift, double least, bool stops) {
    l = a;
    l.diagonal().array() -= shift;
    for (int k = 0; k < kSize; ++k) {
      const double pivot = l(k, k);
      if (!(std::abs(pivot) > least)) {
        double most = 0;
        for (int i = k + 1; i < kSize; ++i) most = std::max(most, std::abs(l(i, k)));
        if (!(most <= least)) is_certain = false;
        if (!is_certain && stops) return;
        l(k, k) = least;
      } else if (pivot < 0) {
        negative = k;
        if (stops) return;
      }
      const double inverse = inverse_pivot[k] = 1 / l(k, k);
      for (int j = k + 1; j < kSize; ++j) {
        const double factor = l(j, k) * inverse;
        for (int i = j; i < kSize; ++i) l(i, j) -= l(i, k) * factor;
      }
      for (int i = k + 1; i < kSize; ++i) l(i, k) *= inverse;
    }
  }

  void solve(Eigen::Vector<double, kSize>& b) const {
    for (int k = 0; k < kSize; ++k)
      for (int i = k + 1; i < kSize; ++i) b[i] -= l(i, k) * b[k];
    for (int k = 0; k < kSize; ++k) b[k] *= inverse_pivot[k];
    back_substitute(b, kSize);
  }

  // L^-T b, of the first rows.
  void back_substitute(Eigen::Vector<double, kSize>& b, int rows) const {
    for (int k = rows - 1; k > 0; --k)
      for (int i = k - 1; i >= 0; --i) b[i] -= l(k, i) * b[k];
  }
};

inline double round_off(int size, double scale) {
  return 4 * size * std::numeric_limits<double>::epsilon() * scale;
}

// By leading minors, which need no division: positive definite beyond rounding. Pre: scale^3 is a number.
inline bool has_positive_minors(const Eigen::Matrix3d& a, double scale) {
  const double least = 2 * round_off(3, scale), second = a(0, 0) * a(1, 1) - a(1, 0) * a(1, 0);
  const double third = a(2, 0) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0)) +
                       a(2, 1) * (a(1, 0) * a(2, 0) - a(0, 0) * a(2, 1)) + a(2, 2) * second;
  return a(0, 0) > least && second > least * scale && third > least * scale * scale;
}

// True where the factors prove it to rounding; `scale` is the greatest entry.
template <int kSize>
bool is_positive_semidefinite(const Eigen::Matrix<double, kSize, kSize>& a, double scale) {
  if constexpr (kSize == 3)
    if (scale > 1e-90 && scale < 1e90 && has_positive_minors(a, scale)) return true;
  SmallFactor<kSize> factor;
  factor.compute(a, 0, round_off(kSize, scale), true);
  return factor.is_certain && factor.negative < 0;
}

// A guess at the smallest eigenvalue of a 4x4 matrix: Laguerre's iteration for the characteristic polynomial,
// from below, where it converges from one side (Parlett 1964). As exact as the coefficients, which is enough.
inline double guess_smallest(const Eigen::Matrix4d& a) {
  const Eigen::Matrix4d square = a * a;
  const double p1 = a.trace(), p2 = square.trace(), p3 = square.cwiseProduct(a).sum(),
               p4 = square.squaredNorm();
  const double c2 = 0.5 * (p1 * p1 - p2), c3 = (c2 * p1 - p1 * p2 + p3) / 3,
               c4 = 0.25 * (c3 * p1 - c2 * p2 + p1 * p3 - p4);
  double x = 0.25 * (p1 - std::sqrt(3 * std::max(0.0, 4 * p2 - p1 * p1)));
  constexpr int kSteps = 2;  // of Laguerre's iteration, which is cubic
  for (int k = 0; k < kSteps; ++k) {
    const double value = (((x - p1) * x + c2) * x - c3) * x + c4,
                 slope = ((4 * x - 3 * p1) * x + 2 * c2) * x - c3, bend = (12 * x - 6 * p1) * x + 2 * c2;
    const double step = 4 * value / (slope - std::sqrt(std::max(0.0, 9 * slope * slope - 12 * value * bend)));
    if (std::isfinite(step)) x -= step;
  }
  return x;
}

// From v, of the Rayleigh quotient `value` or near it, to an eigenvector of the length 1 and its eigenvalue;
// false where it does not converge. The greatest entry of a is about one.
template <int kSize>
bool refine_eigenvector(const Eigen::Matrix<double, kSize, kSize>& a, Eigen::Vector<double, kSize>& v,
                        double& value) {
  constexpr int kMost = 8;  // steps to an eigenvector
  SmallFactor<kSize> factor;
  for (int k = 0; k < kMost; ++k) {
    factor.compute(a, value, std::numeric_limits<double>::epsilon(), false);
    factor.solve(v);
    v *= 1 / v.norm();
    const Eigen::Vector<double, kSize> image = a * v;
    value = v.dot(image);
    if ((image - value * v).cwiseAbs().maxCoeff() <= 0.5 * round_off(kSize, 1)) return true;
  }
  return false;
}

// The sum of -value v v^T over the negative eigenvalues: what makes a positive semidefinite where it is
// added. False where that is not certain; the caller decomposes the matrix then.
template <int kSize>
bool negative_part(Eigen::Matrix<double, kSize, kSize> a, double scale,
                   Eigen::Matrix<double, kSize, kSize>& part) {
  part.setZero();
  if constexpr (kSize == 1) {
    part(0, 0) = std::max(0.0, -a(0, 0));
    return true;
  } else if constexpr (kSize == 2) {
    const double mean = 0.5 * (a(0, 0) + a(1, 1)), half = 0.5 * (a(0, 0) - a(1, 1));
    const double radius = std::sqrt(half * half + a(1, 0) * a(1, 0));
    if (mean - radius >= 0) return true;
    if (mean + radius <= 0) {
      part = -a;
      return true;
    }
    // The smaller eigenvalue times its projector; radius > |mean| >= 0 here.
    const double factor = 0.5 * (radius - mean) / radius;
    part << factor * (radius - half), -factor * a(1, 0), -factor * a(1, 0), factor * (radius + half);
    return true;
  } else {
    a *= 1 / scale;
    for (int found = 0; found <= kSize; ++found) {
      SmallFactor<kSize> factor;
      factor.compute(a, 0, round_off(kSize, 1), true);
      if (!factor.is_certain) return false;
      if (factor.negative < 0) {
        part *= scale;
        return true;
      }
      const int k = factor.negative;
      Eigen::Vector<double, kSize> v = Eigen::Vector<double, kSize>::Unit(k);
      for (int i = 0; i < k; ++i) v[i] = -factor.l(k, i);
      factor.back_substitute(v, k);
      double value = factor.l(k, k) / v.squaredNorm();
      if constexpr (kSize == 4) value = guess_smallest(a);
      if (!refine_eigenvector<kSize>(a, v, value) || !(value < 0)) return false;
      const Eigen::Matrix<double, kSize, kSize> pair = (-value * v) * v.transpose();
      a += pair;
      part += pair;
    }
    return false;
  }
}

}  // namespace coapt
