#include "mesh/orientation.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cmath>

namespace coapt {
namespace {

constexpr double kHalfUlp = 0x1p-53;
// Error of the rounded determinants relative to the sum of the sizes of their products (Shewchuk, section 4).
constexpr double kBound2 = (3 + 16 * kHalfUlp) * kHalfUlp;
constexpr double kBound3 = (7 + 56 * kHalfUlp) * kHalfUlp;

// A sum of doubles that do not overlap, from the smallest to the largest, without zeros.
template <size_t kCapacity>
struct Expansion {
  std::array<double, kCapacity> terms;
  size_t count = 0;

  // Adds one double without error (grow-expansion). Pre: there is room for one more term.
  void add(double value) {
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
      const double term = terms[i], sum = value + term;  // two-sum
      const double part = sum - value;
      const double error = (value - (sum - part)) + (term - part);
      if (error != 0) terms[kept++] = error;
      value = sum;
    }
    if (value != 0) terms[kept++] = value;
    count = kept;
  }

  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }

  template <size_t kOther>
  void add_scaled(const Expansion<kOther>& other, double factor) {
    for (size_t i = 0; i < other.count; ++i) add_product(other.terms[i], factor);
  }

  int sign() const { return count == 0 ? 0 : terms[count - 1] > 0 ? 1 : -1; }
};

Expansion<2> difference(double a, double b) {
  Expansion<2> result;
  result.add(a);
  result.add(-b);
  return result;
}

// u1 v2 - u2 v1
Expansion<16> cross(const Expansion<2>& u1, const Expansion<2>& u2, const Expansion<2>& v1,
                    const Expansion<2>& v2) {
  Expansion<16> result;
  for (size_t i = 0; i < v2.count; ++i) result.add_scaled(u1, v2.terms[i]);
  for (size_t i = 0; i < v1.count; ++i) result.add_scaled(u2, -v1.terms[i]);
  return result;
}

int exact_orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  Expansion<2> u[3], v[3], w[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = difference(b[k], a[k]);
    v[k] = difference(c[k], a[k]);
    w[k] = difference(d[k], a[k]);
  }
  Expansion<192> determinant;
  for (int k = 0; k < 3; ++k) {
    const int m = (k + 1) % 3, n = (k + 2) % 3;
    const Expansion<16> minor = cross(u[m], u[n], v[m], v[n]);
    for (size_t i = 0; i < w[k].count; ++i) determinant.add_scaled(minor, w[k].terms[i]);
  }
  return determinant.sign();
}

}  // namespace

int orientation(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const double left = (b[0] - a[0]) * (c[1] - a[1]), right = (b[1] - a[1]) * (c[0] - a[0]);
  const double determinant = left - right;
  if (std::abs(determinant) > kBound2 * (std::abs(left) + std::abs(right))) return determinant > 0 ? 1 : -1;
  return cross(difference(b[0], a[0]), difference(b[1], a[1]), difference(c[0], a[0]), difference(c[1], a[1]))
      .sign();
}

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  double determinant = 0, size = 0;
  for (int k = 0; k < 3; ++k) {
    const int m = (k + 1) % 3, n = (k + 2) % 3;
    const double left = u[m] * v[n], right = u[n] * v[m];
    determinant += w[k] * (left - right);
    size += std::abs(w[k]) * (std::abs(left) + std::abs(right));
  }
  if (std::abs(determinant) > kBound3 * size) return determinant > 0 ? 1 : -1;
  return exact_orientation(a, b, c, d);
}

}  // namespace coapt
