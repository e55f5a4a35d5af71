// Crimped and splayed fibres written anew: the stress in the lengths of Freed and Doehring 2005, its energy
// as the work of that stress by Gauss's rule on fine pieces, the splay as a mean over directions.
#pragma once

#include "support/oracles.hpp"

#include <array>
#include <numbers>

namespace coapt::oracle {

// Mean square cosine of an angle that is normally distributed about zero with this standard deviation [rad],
// by the trapezoidal rule: for a bell curve it converges faster than any power of the step.
inline double mean_square_cosine(double deviation) {
  constexpr int kReach = 96;  // steps to either side, eight to a deviation
  double sum = 0, weights = 0;
  for (int k = -kReach; k <= kReach; ++k) {
    const double u = k / 8.0, weight = std::exp(-0.5 * u * u), c = std::cos(u * deviation);
    sum += weight * c * c;
    weights += weight;
  }
  return sum / weights;
}

// Mean of a a^T over directions whose angles in the plane, about a mean at an angle to the first axis, and
// out of it are normally distributed with these standard deviations [rad].
inline Eigen::Matrix3d mean_of_directions(double in_plane, double out_of_plane, double angle) {
  constexpr int kReach = 64;  // steps to either side, eight to a deviation
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double weights = 0;
  for (int i = -kReach; i <= kReach; ++i)
    for (int j = -kReach; j <= kReach; ++j) {
      const double u = i / 8.0, v = j / 8.0, weight = std::exp(-0.5 * (u * u + v * v));
      const double t = angle + u * in_plane, p = v * out_of_plane;
      const Eigen::Vector3d a(std::cos(t) * std::cos(p), std::sin(t) * std::cos(p), std::sin(p));
      sum += weight * a * a.transpose();
      weights += weight;
    }
  return sum / weights;
}

// Integral of f from a to b by 64 pieces of Gauss's five-point rule.
template <typename Function>
double gauss_integral(const Function& f, double a, double b) {
  constexpr int kPieces = 64;
  const double root = 2 * std::sqrt(10.0 / 7), half = (b - a) / (2 * kPieces);
  const std::array<double, 2> at{std::sqrt(5 - root) / 3, std::sqrt(5 + root) / 3},
      weight{(322 + 13 * std::sqrt(70.0)) / 900, (322 - 13 * std::sqrt(70.0)) / 900};
  double sum = 0;
  for (int k = 0; k < kPieces; ++k) {
    const double middle = a + (2 * k + 1) * half;
    sum += 128.0 / 225 * f(middle);
    for (int i = 0; i < 2; ++i) sum += weight[i] * (f(middle - half * at[i]) + f(middle + half * at[i]));
  }
  return half * sum;
}

// A helix that is pulled straight. ratio: H0/R0; slenderness: R0/r0; window: half of the stretch over which
// the stiffness rises evenly from that of the crimp at its limit to that of the straight fibre; from a strain
// of the straight fibre on, its yield, it loses a share of that over the same window.
struct CrimpedCurve {
  double young, ratio, slenderness, window;
  double yield = 1e9, failure = 0;
  double R0 = 2.5, H0 = ratio * R0, r0 = R0 / slenderness;
  double L0 = std::sqrt(std::pow(2 * std::numbers::pi * R0, 2) + H0 * H0), limit = L0 / H0;
  double secant = young * H0 * H0 /
                  (L0 * (H0 + (1 + 37 / (6 * std::pow(std::numbers::pi, 2)) +
                               2 * L0 * L0 / std::pow(std::numbers::pi * r0, 2)) *
                                  (L0 - H0)));

  // l: stretch, at most the limit.
  template <typename T>
  T crimped(const T& l) const {
    const double turn = std::pow(2 * std::numbers::pi, 2);
    const T H = times(H0, l), H2 = squared(H), R2 = times(1 / turn, T(T(L0 * L0) - H2));
    const T flat = times(1 / (r0 * r0), R2), sum = T(T(20.0 / 9) + flat), share = T(R2 / H2);
    const T bent = T(sum * share), divisor = T(T(T(1.0) + times(4, flat)) + times(6, bent));
    const T length = times(L0, H), lower = T(length * divisor), upper = T(R2 + H2), eta = T(upper / lower);
    const T e = T(l - T(1.0));
    return times(secant, T(eta * e));
  }
  double slope_at_limit() const {
    AutoInner l(limit);
    l.derivatives()[0] = 1;
    return crimped(l).derivatives()[0];
  }

  double yield_stretch() const { return limit * (1 + yield); }
  template <typename T>
  T lost(const T& l) const {
    const T past = T(l - T(yield_stretch()));
    if (number(past) <= -window) return T(0.0);
    if (number(past) >= window) return times(failure * young / limit, past);
    return times(failure * young / limit / (4 * window), squared(T(past + T(window))));
  }
  template <typename T>
  T stress(const T& l) const {
    return T(whole(l) - lost(l));
  }
  template <typename T>
  T whole(const T& l) const {
    const double past = number(l) - limit;
    if (number(l) <= 1) return T(0.0);
    if (past >= window) return T(T(secant * (limit - 1) - young) + times(young / limit, l));
    if (past <= -window) return crimped(l);
    const double slope = slope_at_limit(), rise = (young / limit - slope) / (4 * window);
    const T tangent = T(T(crimped(limit)) + times(slope, T(l - T(limit))));
    return T((past < 0 ? crimped(l) : tangent) + times(rise, squared(T(l - T(limit - window)))));
  }

  // Per volume. Its derivatives are the stress by definition, whatever the order.
  template <typename T>
  T energy(const T& l) const {
    if constexpr (std::is_same_v<T, double>) {
      double sum = 0, from = 1;
      const double end = yield_stretch();
      for (const double to : {limit - window, limit, limit + window, end - window, end, end + window,
                              std::max(l, end + window)}) {
        if (from < std::min(to, l))
          sum += gauss_integral([this](double at) { return stress(at); }, from, std::min(to, l));
        from = to;
      }
      return sum;
    } else {
      T work(energy(l.value()));
      const auto pull = stress(l.value());
      work.derivatives()[0] = pull * l.derivatives()[0];
      return work;
    }
  }
};

}  // namespace coapt::oracle
