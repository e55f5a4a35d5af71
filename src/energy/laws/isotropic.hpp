// Isotropic membrane laws in plane stress, as functions of the two principal stretches. Energies are per
// volume at rest [stress]. Each is least, and free of stress, at l1 = l2 = 1. A law gives
//   evaluate(l1, l2)       energy and its first and second derivatives
//   free_width(l1)         a guess of the l2 at which a strip stretched by l1 is free of stress across
//   initial_young(), initial_poisson()   of the linear membrane that it is at small strain
#pragma once

#include "energy/laws/bilinear_curve.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {

// Energy and its derivatives with respect to the principal stretches.
struct StretchEnergy {
  double energy = 0;
  double w1 = 0, w2 = 0;
  double w11 = 0, w22 = 0, w12 = 0;
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
  double free_width(double l1) const { return 1 - poisson * (l1 - 1); }
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

// psi = mu/2 (I - 3).
struct NeoHookeanInvariant {
  double shear_modulus = 0;  // mu [stress]

  InvariantEnergy at(double j) const { return {0.5 * shear_modulus * j, 0.5 * shear_modulus, 0}; }
  double initial_shear_modulus() const { return shear_modulus; }
};

// psi = C0/2 (I - 3) + C1/2 (exp(C2 (I - 3)^2) - 1). Source: the form of Lee & Sacks as used for tricuspid
// leaflets by Mathur et al. 2022.
struct ExponentialInvariant {
  double c0 = 0, c1 = 0;  // [stress]
  double c2 = 0;

  InvariantEnergy at(double j) const {
    const double grown = c1 * std::exp(c2 * j * j);
    return {0.5 * (c0 * j + c1 * std::expm1(c2 * j * j)), 0.5 * c0 + c2 * j * grown,
            c2 * (1 + 2 * c2 * j * j) * grown};
  }
  double initial_shear_modulus() const { return c0; }
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
    if (bulk > 0) return with_volume(l1, l2, thin2);
    const InvariantEnergy psi = invariant.at(distortion((l1 - 1) * (l1 + 1), (l2 - 1) * (l2 + 1), thin2));
    const double i1 = 2 * (l1 - thin2 / l1), i2 = 2 * (l2 - thin2 / l2);
    return {psi.energy,
            psi.first * i1,
            psi.first * i2,
            psi.second * i1 * i1 + psi.first * (2 + 6 * thin2 / (l1 * l1)),
            psi.second * i2 * i2 + psi.first * (2 + 6 * thin2 / (l2 * l2)),
            psi.second * i1 * i2 + psi.first * 4 * thin2 * thin};
  }
  double free_width(double l1) const { return 1 / std::sqrt(l1); }
  double initial_young() const {
    const double mu = invariant.initial_shear_modulus();
    return bulk > 0 ? 9 * bulk * mu / (3 * bulk + mu) : 3 * mu;
  }
  double initial_poisson() const {
    const double mu = invariant.initial_shear_modulus();
    return bulk > 0 ? (3 * bulk - 2 * mu) / (6 * bulk + 2 * mu) : 0.5;
  }

 private:
  // f(J) and its derivatives at fixed l1, l2.
  struct Volume {
    double energy, first, second;
    InvariantEnergy psi;
    double di, ddi;  // of the isochoric invariant by J
  };
  Volume volume(double l1, double l2, double thin2, double j) const {
    const double root = std::cbrt(j), a = 1 / (root * root), plane = l1 * l1 + l2 * l2;
    // The stretches without the change of volume, squared, less 1.
    const double shrunk = (1 - root) * (1 + root) * a;
    const double p1 = shrunk + a * (l1 - 1) * (l1 + 1), p2 = shrunk + a * (l2 - 1) * (l2 + 1);
    const double di = (-2.0 / 3 * plane / j + 4.0 / 3 * j * thin2) * a,
                 ddi = (10.0 / 9 * plane / (j * j) + 4.0 / 9 * thin2) * a;
    const InvariantEnergy psi = invariant.at(distortion(p1, p2, thin2 / (a * a)));
    return {psi.energy + 0.5 * bulk * (j - 1) * (j - 1),
            psi.first * di + bulk * (j - 1),
            psi.second * di * di + psi.first * ddi + bulk,
            psi,
            di,
            ddi};
  }

  // psi grows with J - 1 faster than bulk resists, so the least energy lies between no change of volume and
  // the J of least distortion; Newton, kept between them by bisection.
  StretchEnergy with_volume(double l1, double l2, double thin2) const {
    const double plane = l1 * l1 + l2 * l2, least_distortion = std::sqrt(0.5 * plane / thin2);
    double low = std::min(1.0, least_distortion), high = std::max(1.0, least_distortion), j = 1;
    Volume v = volume(l1, l2, thin2, j);
    constexpr int kMost = 100;
    constexpr double kLast = 1e-9;  // the error that a step this small leaves is its square
    for (int k = 0; k < kMost; ++k) {
      (v.first > 0 ? high : low) = j;
      double next = j - v.first / v.second;
      if (!(next >= low && next <= high)) next = 0.5 * (low + high);
      const double moved = std::abs(next - j);
      j = next;
      v = volume(l1, l2, thin2, j);
      if (moved <= kLast * j) break;
    }
    // At fixed J the derivatives by the stretches; then those through J, which the minimum fixes.
    const double root = std::cbrt(j), a = 1 / (root * root), b = j * j * a * thin2;  // I = a plane + b
    const double i1 = 2 * (a * l1 - b / l1), i2 = 2 * (a * l2 - b / l2);
    const double da = -2.0 / 3 * a / j, db = 4.0 / 3 * b / j;
    const double i1j = 2 * (da * l1 - db / l1), i2j = 2 * (da * l2 - db / l2);
    const double second = v.psi.second, first = v.psi.first;
    const double w1j = second * i1 * v.di + first * i1j, w2j = second * i2 * v.di + first * i2j;
    return {v.energy,
            first * i1,
            first * i2,
            second * i1 * i1 + first * (2 * a + 6 * b / (l1 * l1)) - w1j * w1j / v.second,
            second * i2 * i2 + first * (2 * a + 6 * b / (l2 * l2)) - w2j * w2j / v.second,
            second * i1 * i2 + first * 4 * b / (l1 * l2) - w1j * w2j / v.second};
  }
};

using NeoHookeanLaw = InvariantLaw<NeoHookeanInvariant>;
using ExponentialLaw = InvariantLaw<ExponentialInvariant>;

}  // namespace coapt
