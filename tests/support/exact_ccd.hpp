// Judge of continuous collision detection, without rounding and without any of the library's code.
// Two sides stay apart over an interval of time if one plane lies between them at both of its ends, since
// every corner moves on a straight line. The interval is halved until such planes are found: each is the best
// one at the middle, where all numbers are integers times powers of two; that it separates at the ends is
// checked exactly.
#pragma once

#include <Eigen/Core>

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <vector>

namespace exact_ccd {

using Integer = boost::multiprecision::number<
    boost::multiprecision::cpp_int_backend<512, 0, boost::multiprecision::signed_magnitude,
                                           boost::multiprecision::unchecked, std::allocator<std::uint64_t>>>;

// mantissa * 2^exponent. Doubles, their sums and products are such numbers.
struct Dyadic {
  Integer mantissa = 0;
  int exponent = 0;

  Dyadic() = default;
  Dyadic(double value) {
    int shift = 0;
    mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &shift), 53));
    exponent = shift - 53;
  }

  int sign() const { return mantissa.sign(); }
  int top() const {
    return static_cast<int>(msb(Integer(abs(mantissa)))) + exponent;
  }                                  // of a value that is not 0
  double rounded(int scale) const {  // value * 2^-scale
    if (sign() == 0) return 0;
    const Integer size = abs(mantissa);
    const int shift = std::max(0, static_cast<int>(msb(size)) - 62);
    const double value = static_cast<double>(static_cast<std::int64_t>(Integer(size >> shift)));
    return sign() * std::ldexp(value, exponent + shift - scale);
  }
};

inline Dyadic operator*(const Dyadic& a, const Dyadic& b) {
  Dyadic c;
  c.mantissa = a.mantissa * b.mantissa;
  c.exponent = a.exponent + b.exponent;
  return c;
}
inline Dyadic operator+(const Dyadic& a, const Dyadic& b) {
  if (a.sign() == 0) return b;
  if (b.sign() == 0) return a;
  Dyadic c;
  c.exponent = std::min(a.exponent, b.exponent);
  c.mantissa = (a.mantissa << (a.exponent - c.exponent)) + (b.mantissa << (b.exponent - c.exponent));
  return c;
}
inline Dyadic operator-(Dyadic a) {
  a.mantissa = -a.mantissa;
  return a;
}
inline Dyadic operator-(const Dyadic& a, const Dyadic& b) { return a + -b; }

using Exact3 = std::array<Dyadic, 3>;
inline Dyadic dot(const Exact3& a, const Exact3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Exact3 operator-(const Exact3& a, const Exact3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Exact3 operator+(const Exact3& a, const Exact3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Exact3 operator*(const Dyadic& s, const Exact3& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Exact3 cross(const Exact3& a, const Exact3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

enum class Answer { Apart, Near, Undecided };

class MovingPair {
 public:
  using Corners = Eigen::Matrix<double, 3, 4>;

  // Corners [0, first) are one side, the others the other side, at x + t d.
  MovingPair(const Corners& x, const Corners& d, int first) {
    for (int i = 0; i < first; ++i)
      for (int j = first; j < 4; ++j) {
        start_.push_back(column(x, i) - column(x, j));
        speed_.push_back(column(d, i) - column(d, j));
      }
  }

  // A lower bound of the distance at the start, off by rounding only.
  double distance() const {
    const std::vector<Exact3> at = differences(0);
    const Plane plane = best_plane(at);
    double bound = plane.gap;
    while (bound > 0 && !is_apart(at, plane.normal, bound)) bound *= 1 - 1e-15;
    return std::max(bound, 0.0);
  }

  // Apart: proven to be at least `distance` (> 0) apart at all times in [0, until]. Near: found closer than
  // that.
  Answer stays_apart(double until, double distance) const {
    return stays_apart(0, until, differences(0), differences(until), distance, 60);
  }

 private:
  struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    double gap = 0;  // distance between the sides along the normal, rounded
  };

  static Exact3 column(const Corners& x, int k) { return {x(0, k), x(1, k), x(2, k)}; }

  std::vector<Exact3> differences(const Dyadic& t) const {
    std::vector<Exact3> at;
    for (size_t k = 0; k < start_.size(); ++k) at.push_back(start_[k] + t * speed_[k]);
    return at;
  }

  // The sides' differences fill a triangle or parallelogram; the point of it that is closest to the origin is
  // a corner, lies on an edge or inside. One of the directions tried is that to the closest point. They are
  // compared with rounding: it decides how many intervals are needed, never the answer.
  static Plane best_plane(const std::vector<Exact3>& at) {
    std::vector<Eigen::Vector3d> rough;
    for (const Exact3& m : at) rough.emplace_back(m[0].rounded(0), m[1].rounded(0), m[2].rounded(0));
    Plane best;
    const auto consider = [&](const Exact3& n) {
      const Eigen::Vector3d normal = rounded(n).normalized();
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (const Eigen::Vector3d& m : rough) {
        low = std::min(low, normal.dot(m));
        high = std::max(high, normal.dot(m));
      }
      if (low > best.gap) best = {normal, low};
      if (-high > best.gap) best = {-normal, -high};
    };
    for (size_t i = 0; i < at.size(); ++i) {
      consider(at[i]);
      for (size_t j = i + 1; j < at.size(); ++j) {
        const Exact3 u = at[j] - at[i];
        consider(dot(u, u) * at[i] - dot(u, at[i]) * u);
      }
    }
    consider(cross(at[1] - at[0], at[2] - at[0]));
    best.gap = std::numeric_limits<double>::infinity();
    const Exact3 n = {best.normal[0], best.normal[1], best.normal[2]};
    for (const Exact3& m : at) best.gap = std::min(best.gap, dot(n, m).rounded(0));
    return best;
  }

  static Eigen::Vector3d rounded(const Exact3& n) {
    int top = std::numeric_limits<int>::min();
    for (const Dyadic& value : n)
      if (value.sign() != 0) top = std::max(top, value.top());
    return {n[0].rounded(top), n[1].rounded(top), n[2].rounded(top)};
  }

  static bool is_apart(const std::vector<Exact3>& at, const Eigen::Vector3d& normal, double distance) {
    const Exact3 n = {normal[0], normal[1], normal[2]};
    const Dyadic least_squared = Dyadic(distance) * Dyadic(distance) * dot(n, n);
    for (const Exact3& m : at) {
      const Dyadic along = dot(n, m);
      if (along.sign() <= 0 || (along * along - least_squared).sign() < 0) return false;
    }
    return true;
  }

  Answer stays_apart(const Dyadic& from, const Dyadic& to, const std::vector<Exact3>& at_from,
                     const std::vector<Exact3>& at_to, double distance, int depth) const {
    const Dyadic middle = Dyadic(0.5) * (from + to);
    const std::vector<Exact3> at = differences(middle);
    const Plane plane = best_plane(at);
    if (plane.gap < distance * (1 - 1e-12)) return Answer::Near;
    if (is_apart(at_from, plane.normal, distance) && is_apart(at_to, plane.normal, distance))
      return Answer::Apart;
    if (depth == 0) return Answer::Undecided;
    const Answer first = stays_apart(from, middle, at_from, at, distance, depth - 1);
    return first == Answer::Apart ? stays_apart(middle, to, at, at_to, distance, depth - 1) : first;
  }

  std::vector<Exact3> start_, speed_;
};

}  // namespace exact_ccd
