// Isotropic membrane laws in plane stress, as functions of the two principal stretches. Energies are per
// volume at rest [stress]. Each is least, and free of stress, at l1 = l2 = 1. A law gives
//   evaluate(l1, l2)       energy and its first and second derivatives
//   free_width(l1)         the l2 at which a strip stretched by l1 is free of stress across, or a guess of it
//   evaluate(l1, width)    the same as evaluate(l1, width.width), with what was found on the way to it
//   initial_young(), initial_poisson()   of the linear membrane that it is at small strain
#pragma once

#include "energy/laws/bilinear_curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace coapt {

// Energy and its derivatives with respect to the principal stretches.
struct StretchEnergy {
  double energy = 0;
  double w1 = 0, w2 = 0;
  double w11 = 0, w22 = 0, w12 = 0;
};

struct FreeWidth {
  double width = 1;
  bool is_exact = false;
  double root = 0;  // cube root of the volume ratio; 0: not known
};

// Bilinear law: linear elastic with E_pre, and beyond the knee of each principal strain e_i = l_i - 1 stiffer
// by E_post - E_pre in its direction:
//   W = E_pre / (2 (1 - nu^2)) (e1^2 + e2^2 + 2 nu e1 e2) + phi(e1) + phi(e2)
// A strip under uniaxial tension follows nominal stress = E_pre e up to the knee and E_post slope beyond,
// exactly. Source: Hammer et al. 2008 (the curve, there of springs); the membrane around it is our own.
struct BilinearLaw {
  double young = 0;  // E_pre [stress]
  double poisson = 0;
  BilinearKnee knee;  // modulus E_post - E_pre

  StretchEnergy evaluate(double l1, double l2) const {
    const double k = young / (1 - poisson * poisson), e1 = l1 - 1, e2 = l2 - 1;
    const CurveValue a = knee.at(e1), b = knee.at(e2);
    return {k * (0.5 * (e1 * e1 + e2 * e2) + poisson * e1 * e2) + a.energy + b.energy,
            k * (e1 + poisson * e2) + a.stress,
            k * (e2 + poisson * e1) + b.stress,
            k + a.stiffness,
            k + b.stiffness,
            k * poisson};
  }
  FreeWidth free_width(double l1) const { return {1 - poisson * (l1 - 1)}; }
  StretchEnergy evaluate(double l1, const FreeWidth& free) const { return evaluate(l1, free.width); }
  double initial_young() const { return young; }
  double initial_poisson() const { return poisson; }
};

// I1 - 3 of a strain without change of volume, by its squared principal stretches: a and b the first two less
// 1, `third` the last. Without the cancellation of 3, which at small strain would leave nothing of an energy
// that goes with the square.
inline double distortion(double a, double b, double third) {
  return (a * a + a * b + b * b + a * b * (a + b)) * third;
}

// psi(j) of the first invariant, j = I - 3, and its derivatives.
struct InvariantEnergy {
  double energy = 0, first = 0, second = 0;
};

// ln psi' and psi''/psi', which stay finite where an exponential overflows.
struct LogSlope {
  double log = 0, growth = 0;
};

// psi = mu/2 (I - 3).
struct NeoHookeanInvariant {
  double shear_modulus = 0;  // mu [stress]

  InvariantEnergy at(double j) const { return {0.5 * shear_modulus * j, 0.5 * shear_modulus, 0}; }
  LogSlope log_slope(double /*j*/) const { return {std::log(0.5 * shear_modulus), 0}; }
  double initial_shear_modulus() const { return shear_modulus; }
};

// psi = C0/2 (I - 3) + C1/2 (exp(C2 (I - 3)^2) - 1) up to j = limit, and beyond it along its tangent: the
// parabola that has its value, slope and curvature there. Without a limit the law as it was published.
// Source: the form of Lee & Sacks as used for tricuspid leaflets by Mathur et al. 2022; the limit, which
// solvers set and take away (energy/stress_limit.hpp), is our own.
struct ExponentialInvariant {
  double c0 = 0, c1 = 0;  // [stress]
  double c2 = 0;
  double limit = std::numeric_limits<double>::infinity();

  InvariantEnergy at(double j) const {
    if (j <= limit) return exponential(j);
    const InvariantEnergy end = exponential(limit);
    const double past = j - limit;
    return {end.energy + (end.first + 0.5 * end.second * past) * past, end.first + end.second * past,
            end.second};
  }
  LogSlope log_slope(double j) const {
    if (j > limit) {
      const InvariantEnergy w = at(j);
      return {std::log(w.first), w.second / w.first};
    }
    // ln(a + b) of the constant and the exponential part of psi'.
    const double a = std::log(0.5 * c0), b = c2 * j * j + std::log(c1 * c2 * std::max(j, 0.0));
    const double most = std::max(a, b), log = most + std::log1p(std::exp(std::min(a, b) - most));
    if (!(b > a - kNegligible)) return {log, 2 * c1 * c2 / c0};
    return {log, std::exp(b - log) * (1 / j + 2 * c2 * j)};
  }
  double initial_shear_modulus() const { return c0; }

  // The limit where psi' is this much [stress].
  void limit_stress(double slope) {
    limit = std::numeric_limits<double>::infinity();
    if (slope < limit) limit = strain_of(std::log(slope));
  }

  // EnergyTerm::raise_stress_limits() of an element at j.
  double raise_limit(double j) {
    if (!(j > limit)) return 0;
    const double stress = std::min(log_slope(j).log, log_slope(limit).log + kMostRise);
    limit = std::numeric_limits<double>::infinity();
    const double excess = log_slope(j).log - stress;
    limit = strain_of(stress);
    return excess;
  }

 private:
  // The j at which ln psi' of the law itself is this much; 0 where it is less everywhere. Newton on ln psi',
  // which is all but a parabola.
  double strain_of(double log_stress) const {
    if (!(log_stress > std::log(0.5 * c0))) return 0;
    const ExponentialInvariant whole{c0, c1, c2};
    double low = 0, high = 1;
    while (whole.log_slope(high).log < log_stress) high *= 2;
    double j = high;
    for (int k = 0; k < 100 && high - low > 1e-14 * high; ++k) {
      const LogSlope slope = whole.log_slope(j);
      (slope.log < log_stress ? low : high) = j;
      const double next = j - (slope.log - log_stress) / slope.growth;
      const bool is_there = std::abs(next - j) <= 1e-12 * j;
      j = next >= low && next <= high ? next : 0.5 * (low + high);
      if (is_there) break;
    }
    return j;
  }

  static constexpr double kMostRise = 2.3;    // of ln psi' at the limit in one raise: ten times the stress
  static constexpr double kNegligible = 700;  // a summand smaller by a factor exp(700) underflows

  InvariantEnergy exponential(double j) const {
    const double grown = std::expm1(c2 * j * j), slope = c1 * c2 * (1 + grown);
    return {0.5 * (c0 * j + c1 * grown), 0.5 * c0 + j * slope, (1 + 2 * c2 * j * j) * slope};
  }
};

// A law of the first invariant in plane stress.
//   incompressible (bulk = 0): W = psi(I1),                      l3 = 1/(l1 l2)
//   else:  W = min over J of psi(J^(-2/3) I1) + bulk/2 (J - 1)^2,  l3 = J/(l1 l2), which makes the stress
//          across the thickness vanish
// bulk [stress]; I1 = l1^2 + l2^2 + l3^2. Source: Holzapfel 2000, chapter 6.
template <typename Invariant>
struct InvariantLaw {
  Invariant invariant;
  double bulk = 0;

  StretchEnergy evaluate(double l1, double l2) const {
    const double thin = 1 / (l1 * l2), thin2 = thin * thin;  // l3 at constant volume, squared
    if (bulk > 0) return with_volume(l1, l2, thin2, balanced_root(l1, l2, thin2));
    const InvariantEnergy psi = invariant.at(distortion((l1 - 1) * (l1 + 1), (l2 - 1) * (l2 + 1), thin2));
    const double i1 = 2 * (l1 - thin2 / l1), i2 = 2 * (l2 - thin2 / l2);
    return {psi.energy,
            psi.first * i1,
            psi.first * i2,
            psi.second * i1 * i1 + psi.first * (2 + 6 * thin2 / (l1 * l1)),
            psi.second * i2 * i2 + psi.first * (2 + 6 * thin2 / (l2 * l2)),
            psi.second * i1 * i2 + psi.first * 4 * thin2 * thin};
  }
  // A strip that is free across is as much so across its thickness: l2 = l3 = sqrt(J/l1), with the J of least
  // energy.
  FreeWidth free_width(double l1) const {
    if (bulk == 0) return {std::sqrt(1 / l1), true};
    const double root = root_by_newton(l1 * l1 * l1, [&](double at) { return strip(l1, at); });
    return root > 0 ? FreeWidth{std::sqrt(cube(root) / l1), true, root} : FreeWidth{std::sqrt(1 / l1)};
  }
  StretchEnergy evaluate(double l1, const FreeWidth& free) const {
    if (free.root == 0) return evaluate(l1, free.width);
    const double thin = 1 / (l1 * free.width);
    return with_volume(l1, free.width, thin * thin, free.root);
  }
  // I1 - 3, of the isochoric part where the volume changes.
  double strain(double l1, double l2) const {
    const double thin = 1 / (l1 * l2), thin2 = thin * thin;
    if (bulk > 0) return volume(l1, l2, thin2, balanced_root(l1, l2, thin2)).invariant;
    return distortion((l1 - 1) * (l1 + 1), (l2 - 1) * (l2 + 1), thin2);
  }
  // J of the volume: l1 l2 l3.
  double volume_ratio(double l1, double l2) const {
    return bulk > 0 ? cube(balanced_root(l1, l2, 1 / (l1 * l2 * l1 * l2))) : 1;
  }
  double initial_young() const {
    const double mu = invariant.initial_shear_modulus();
    return bulk > 0 ? 9 * bulk * mu / (3 * bulk + mu) : 3 * mu;
  }
  double initial_poisson() const {
    const double mu = invariant.initial_shear_modulus();
    return bulk > 0 ? (3 * bulk - 2 * mu) / (6 * bulk + 2 * mu) : 0.5;
  }

 private:
  // Of the cube root of J, by which J is found, as the invariant needs it: the error that a step this small
  // leaves is its square.
  static constexpr double kLastStep = 1e-9;

  static double cube(double root) { return root * root * root; }

  // W and its derivatives by J at fixed stretches.
  struct Volume {
    double energy, first, second;
    double invariant, di;  // isochoric, less 3, and its derivative by J
    InvariantEnergy psi;
  };
  Volume with_invariant(double root, double isochoric, double di, double ddi) const {
    const double j = cube(root);
    const InvariantEnergy psi = invariant.at(isochoric);
    return {psi.energy + 0.5 * bulk * (j - 1) * (j - 1),
            psi.first * di + bulk * (j - 1),
            psi.second * di * di + psi.first * ddi + bulk,
            isochoric,
            di,
            psi};
  }
  Volume volume(double l1, double l2, double thin2, double root) const {
    const double j = cube(root), a = 1 / (root * root), plane = l1 * l1 + l2 * l2;
    // The stretches without the change of volume, squared, less 1.
    const double shrunk = (1 - root) * (1 + root) * a;
    const double p1 = shrunk + a * (l1 - 1) * (l1 + 1), p2 = shrunk + a * (l2 - 1) * (l2 + 1);
    const double di = (-2.0 / 3 * plane / j + 4.0 / 3 * j * thin2) * a,
                 ddi = (10.0 / 9 * plane / (j * j) + 4.0 / 9 * thin2) * a;
    return with_invariant(root, distortion(p1, p2, thin2 / (a * a)), di, ddi);
  }
  // The same of a strip that is free across.
  Volume strip(double l1, double root) const {
    const double j = cube(root), a = 1 / (root * root), along = l1 * l1 / j;
    const double p1 = (1 - root) * (1 + root) * a + a * (l1 - 1) * (l1 + 1), p2 = (root - l1) / l1;
    const double di = 2.0 / 3 * a * (1 / l1 - along), ddi = 2.0 / 9 * a / j * (5 * along - 2 / l1);
    return with_invariant(root, distortion(p1, p2, 1 + p2), di, ddi);
  }

  // The cube root of the J of least energy, which lies between 1 and that of least distortion, by Newton's
  // method from 1. A few steps where the bulk modulus outweighs psi; 0 where they do not suffice, as on the
  // steep side of an exponential.
  template <typename AtRoot>
  double root_by_newton(double least_distortion, const AtRoot& at) const {
    constexpr int kMost = 6;  // steps
    const double low = std::min(1.0, least_distortion), high = std::max(1.0, least_distortion);
    double root = 1;
    for (int k = 0; k < kMost; ++k) {
      const Volume v = at(root);
      const double next = root - v.first / v.second / (3 * root * root), j = cube(next);
      if (!std::isfinite(v.second) || !(j >= low && j <= high)) return 0;
      if (std::abs(next - std::exchange(root, next)) <= kLastStep * next) return root;
    }
    return 0;
  }

  // The cube root of the J of least energy. Where Newton's method does not find it: with r* that of the J*
  // of least distortion, r = 1 + (r* - 1) s and u = ln(s/(1 - s)) the stress of psi and that of the bulk
  // modulus balance where
  //   ln psi'(j) + ln(4 thin2/(3 bulk) (J* + J) (r*^2 + r* r + r^2) / (r^5 (r^2 + r + 1))) - u = 0,
  // which falls with u from +infinity to -infinity, nearly along a straight line however steep psi is. Newton
  // in u, kept in its bracket by bisection.
  double balanced_root(double l1, double l2, double thin2) const {
    const double least_distortion = std::sqrt(0.5 * (l1 * l1 + l2 * l2) / thin2);
    const auto at = [&](double root) { return volume(l1, l2, thin2, root); };
    if (const double found = root_by_newton(least_distortion, at); found > 0) return found;
    const double end = std::cbrt(least_distortion), width = end - 1;
    constexpr int kMost = 200;          // steps towards the change of volume
    constexpr double kMostLogit = 700;  // beyond it exp() overflows

    double low = -kMostLogit, high = kMostLogit, u = 0, share = 0.5, left = 0.5;  // s and 1 - s
    double root = 1 + 0.5 * width;
    for (int k = 0; k < kMost; ++k) {
      const Volume v = at(root);
      const LogSlope slope = std::isfinite(v.psi.first) && std::isfinite(v.psi.second)
                                 ? LogSlope{std::log(v.psi.first), v.psi.second / v.psi.first}
                                 : invariant.log_slope(v.invariant);
      const double square = root * root, j = cube(root), from_end = end * (end + root) + square,
                   from_one = 1 + root + square;
      const double balance =
          slope.log - u +
          std::log(4 * thin2 / (3 * bulk) * (least_distortion + j) * from_end / (square * j * from_one));
      (balance > 0 ? low : high) = u;
      const double by_u = width * share * left;  // dr/du
      const double by_root = slope.growth * v.di * 3 * square + 3 * square / (least_distortion + j) +
                             (end + 2 * root) / from_end - 5 / root - (1 + 2 * root) / from_one;
      u -= balance / (by_root * by_u - 1);
      if (!(u >= low && u <= high)) u = 0.5 * (low + high);
      const double odds = std::exp(-u);
      share = 1 / (1 + odds);
      left = odds / (1 + odds);
      const double last = std::exchange(root, u < 0 ? 1 + width * share : end - width * left);
      if (std::abs(root - last) <= kLastStep * root) break;
    }
    return root;
  }

  // root: of the J of least energy.
  StretchEnergy with_volume(double l1, double l2, double thin2, double root) const {
    const double j = cube(root);
    const Volume v = volume(l1, l2, thin2, root);
    // At fixed J the derivatives by the stretches; then those through J, which the minimum fixes.
    const double a = 1 / (root * root), b = j * j * a * thin2;  // I = a plane + b
    const double i1 = 2 * (a * l1 - b / l1), i2 = 2 * (a * l2 - b / l2);
    const double da = -2.0 / 3 * a / j, db = 4.0 / 3 * b / j;
    const double i1j = 2 * (da * l1 - db / l1), i2j = 2 * (da * l2 - db / l2);
    const double second = v.psi.second, first = v.psi.first;
    const double w1j = second * i1 * v.di + first * i1j, w2j = second * i2 * v.di + first * i2j;
    return {v.energy,
            first * i1,
            first * i2,
            second * i1 * i1 + first * (2 * a + 6 * b / (l1 * l1)) - w1j * (w1j / v.second),
            second * i2 * i2 + first * (2 * a + 6 * b / (l2 * l2)) - w2j * (w2j / v.second),
            second * i1 * i2 + first * 4 * b / (l1 * l2) - w1j * (w2j / v.second)};
  }
};

using NeoHookeanLaw = InvariantLaw<NeoHookeanInvariant>;
using ExponentialLaw = InvariantLaw<ExponentialInvariant>;

}  // namespace coapt
