// Membrane laws with a fibre direction, in plane stress, as functions of the right Cauchy-Green tensor C in
// axes of which the first lies along the fibre. Energies are per volume at rest [stress]; each is least, and
// free of stress, at C = I alone. A law gives
//   evaluate(c11, c22, c12)   energy, second Piola-Kirchhoff stress and tangent (E11, E22, 2 E12)
//   initial_young(), initial_poisson()   of the isotropic membrane that comes nearest at small strain
#pragma once

#include "energy/laws/crimped_fibre.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace coapt {

// Energy and its derivatives by the Green strains (E11, E22, 2 E12).
struct PlaneEnergy {
  double energy = 0;
  Eigen::Vector3d stress = Eigen::Vector3d::Zero();
  Eigen::Matrix3d tangent = Eigen::Matrix3d::Zero();
};

// A function of C and its derivatives by (E11, E22, 2 E12).
struct PlaneInvariant {
  double value = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

// I1 - 3 = tr C + 1/det C - 3 of an incompressible membrane, without the cancellation of 3.
inline PlaneInvariant first_invariant(double c11, double c22, double c12) {
  const double thin = 1 / (c11 * c22 - c12 * c12);
  const double a = c11 - 1, b = c22 - 1, shear = c12 * c12;
  const double distortion = (a * a + a * b + b * b + shear + (a + b) * (a * b - shear)) * thin;
  const Eigen::Vector3d slope(2 * c22, 2 * c11, -2 * c12);  // of det C
  PlaneInvariant i{distortion, Eigen::Vector3d(2, 2, 0) - thin * thin * slope,
                   2 * thin * thin * thin * slope * slope.transpose()};
  i.second(0, 1) -= 4 * thin * thin;
  i.second(1, 0) -= 4 * thin * thin;
  i.second(2, 2) += 2 * thin * thin;
  return i;
}

// f(i): adds its energy and derivatives.
inline void add_composed(const CurveValue& f, const PlaneInvariant& i, PlaneEnergy& sum) {
  sum.energy += f.energy;
  sum.stress += f.stress * i.first;
  sum.tangent += f.stiffness * i.first * i.first.transpose() + f.stress * i.second;
}

// sqrt(k11 C11 + k22 C22): the stretch along the fibre (1, 0), across it (0, 1), or the root mean square of
// fibres spread about it.
inline PlaneInvariant stretch_of(double k11, double k22, double c11, double c22) {
  const double l = std::sqrt(k11 * c11 + k22 * c22);
  const Eigen::Vector3d slope(k11 / l, k22 / l, 0);
  return {l, slope, -slope * slope.transpose() / l};
}

// Dispersion of fibres about a mean direction: K, the mean of a a^T over their directions a at rest, of trace
// 1; its entries in the plane and normal to it.
struct FibreDispersion {
  double k11 = 1, k22 = 0, k12 = 0, k33 = 0;
};

// Of two independent, normally distributed angles of standard deviation s in the plane and n out of it [rad],
// a = (cos t cos p, sin t cos p, sin p), about a mean direction at an angle to the first axis [rad]:
//   along  (1 + exp(-2 s^2)) (1 + exp(-2 n^2))/4,   across  (1 - exp(-2 s^2)) (1 + exp(-2 n^2))/4,
//   normal (1 - exp(-2 n^2))/2
// Sources: Freed, Einstein & Vesely 2005 (splay invariant, with one parameter in the plane and further ones
// in space), Toma et al. 2016, eq. 2.
inline FibreDispersion fibre_dispersion(double in_plane, double out_of_plane, double angle) {
  const double spread = std::exp(-2 * in_plane * in_plane), flat = std::exp(-2 * out_of_plane * out_of_plane);
  const double along = 0.5 * (1 + spread) * (0.5 * (1 + flat)),
               across = 0.5 * (1 - spread) * (0.5 * (1 + flat));
  if (angle == 0) return {along, across, 0, 0.5 * (1 - flat)};
  const double c = std::cos(angle), s = std::sin(angle);
  return {along * c * c + across * s * s, along * s * s + across * c * c, (along - across) * c * s,
          0.5 * (1 - flat)};
}

// sqrt(K : C) of an incompressible membrane, whose C33 is 1/det C: the root mean square stretch of dispersed
// fibres.
inline PlaneInvariant stretch_of(const FibreDispersion& k, double c11, double c22, double c12) {
  if (k.k12 == 0 && k.k33 == 0) return stretch_of(k.k11, k.k22, c11, c22);
  const double thin = k.k33 > 0 ? 1 / (c11 * c22 - c12 * c12) : 0, normal = k.k33 * thin * thin;
  const double l = std::sqrt(k.k11 * c11 + k.k22 * c22 + 2 * k.k12 * c12 + k.k33 * thin);
  const Eigen::Vector3d slope(2 * c22, 2 * c11, -2 * c12);  // of det C
  const Eigen::Vector3d first = (Eigen::Vector3d(k.k11, k.k22, k.k12) - 0.5 * normal * slope) / l;
  Eigen::Matrix3d second = normal * thin * slope * slope.transpose() - first * first.transpose();
  second(0, 1) -= 2 * normal;
  second(1, 0) -= 2 * normal;
  second(2, 2) += normal;
  return {l, first, second / l};
}

// A bilinear curve along the fibre and one across it, with strains e = stretch - 1 in those directions:
//   W = (E_f e_f^2 + E_c e_c^2 + 2 nu sqrt(E_f E_c) e_f e_c) / (2 (1 - nu^2)) + phi_f(e_f) + phi_c(e_c)
//       + G/2 C12^2
// E_f, E_c the moduli before the knees; uniaxial tension along either direction follows its curve exactly up
// to the other's knee. Source: Hammer et al. 2011 (the two curves, there of springs); coupling and shear are
// our own.
struct OrthotropicLaw {
  double fibre_young = 0, cross_young = 0;  // E_f, E_c [stress]
  BilinearKnee fibre_knee, cross_knee;
  double poisson = 0;        // nu
  double shear_modulus = 0;  // G [stress]

  PlaneEnergy evaluate(double c11, double c22, double c12) const {
    const PlaneInvariant f = stretch_of(1, 0, c11, c22), c = stretch_of(0, 1, c11, c22);
    const double ef = f.value - 1, ec = c.value - 1, share = 1 / (1 - poisson * poisson);
    const double k = poisson * share * std::sqrt(fibre_young * cross_young);
    PlaneEnergy sum;
    const auto add = [&](double young, const BilinearKnee& knee, double own, double other,
                         const PlaneInvariant& stretch) {
      const CurveValue past = knee.at(own);
      // Half of the coupled energy each.
      add_composed({0.5 * share * young * own * own + 0.5 * k * own * other + past.energy,
                    share * young * own + k * other + past.stress, share * young + past.stiffness},
                   stretch, sum);
    };
    add(fibre_young, fibre_knee, ef, ec, f);
    add(cross_young, cross_knee, ec, ef, c);
    const Eigen::Matrix3d mixed = k * f.first * c.first.transpose();
    sum.tangent += mixed + mixed.transpose();
    sum.energy += 0.5 * shear_modulus * c12 * c12;
    sum.stress[2] += shear_modulus * c12;
    sum.tangent(2, 2) += shear_modulus;
    return sum;
  }
  double initial_young() const { return std::sqrt(fibre_young * cross_young); }
  double initial_poisson() const { return poisson; }
};

// W = c0 (exp(Q) - 1),  Q = c1 (I1 - 3)^2 + c2 (l_f - 1)^4,  incompressible; l_f stretch along the fibre.
// Without stiffness at rest. Source: May-Newman & Yin 1998. Beyond Q = limit the exponential goes on along
// its tangent parabola (EnergyTerm::limit_stress(), our own); without a limit the law is as published.
struct MayNewmanYinLaw {
  double c0 = 0;  // [stress]
  double c1 = 0, c2 = 0;
  double limit = std::numeric_limits<double>::infinity();

  // Q, which is finite where exp(Q) overflows, and least where W is.
  PlaneEnergy exponent(double c11, double c22, double c12) const {
    const PlaneInvariant i = first_invariant(c11, c22, c12), l = stretch_of(1, 0, c11, c22);
    const double j = i.value, e = l.value - 1;
    PlaneEnergy q;
    add_composed({c1 * j * j, 2 * c1 * j, 2 * c1}, i, q);
    add_composed({c2 * e * e * e * e, 4 * c2 * e * e * e, 12 * c2 * e * e}, l, q);
    return q;
  }
  PlaneEnergy evaluate(double c11, double c22, double c12) const {
    const PlaneEnergy q = exponent(c11, c22, c12);
    const double at = std::min(q.energy, limit), past = q.energy > limit ? q.energy - limit : 0;
    const double grown = c0 * std::exp(at), slope = grown * (1 + past);
    return {c0 * std::expm1(at) + (past > 0 ? grown * (past + 0.5 * past * past) : 0), slope * q.stress,
            slope * q.tangent + grown * q.stress * q.stress.transpose()};
  }
  // The limit where c0 exp(Q) is this much [stress].
  void limit_stress(double stress) { limit = std::max(0.0, std::log(stress / c0)); }
  // EnergyTerm::raise_stress_limits() of an element with this energy.
  double raise_limit(double energy) {
    const double over = (energy / c0 - std::expm1(limit)) * std::exp(-limit);  // past + past^2/2
    if (!(over > 0)) return 0;
    const double past = std::sqrt(1 + 2 * over) - 1, excess = past - std::log1p(past);
    limit += std::min(std::log1p(past), 2.3);  // ten times the stress at most
    return excess;
  }
  // There is none at rest: the secant of a strip pulled along the fibre by a tenth.
  double initial_young() const {
    const double l = 1.1, e = l - 1, j = l * l + 2 / l - 3;
    const double q = c1 * j * j + c2 * e * e * e * e;
    return c0 * std::exp(q) * (2 * c1 * j * 2 * (l - 1 / (l * l)) + 4 * c2 * e * e * e) / e;
  }
  double initial_poisson() const { return 0.5; }
};

// Crimped fibres in an incompressible neo-Hookean matrix:
//   W = mu/2 (I1 - 3) + w(l_1) + r w(l_2) + a(l_1),   l_i^2 = K_i : C,   C33 = 1/det C
// w of the crimped fibre (energy/laws/crimped_fibre.hpp); K_i the dispersion of each of two populations, the
// second at an angle to the first and r times as strong. The active stress of fibres longer than at rest is
// a' = T (1 - exp(-(l_1 - 1)/e_a)), zero at rest as that of every law here must be. Sources: Toma et al.
// 2016, eq. 1 and 2 (two populations, active part, dispersion); Freed, Einstein & Vesely 2005 (dispersion).
// The paper prints neither direction and share of the second population nor the rule of the active stress:
// their form is ours.
struct CrimpedFibreLaw {
  double shear_modulus = 0;  // mu [stress]
  CrimpedFibre fibre;
  double splay = 0, splay_out_of_plane = 0;      // standard deviations of the fibres' angles [rad]
  double second_population = 0;                  // r; 0: there is none
  double second_angle = 0.5 * std::numbers::pi;  // from the first to the second, in the plane [rad]
  double active_stress = 0;                      // T [stress]

  static constexpr double kActivation = 0.02;  // e_a, elongation over which the active stress sets in

  PlaneEnergy evaluate(double c11, double c22, double c12) const {
    const PlaneInvariant i = first_invariant(c11, c22, c12), l = population(0, c11, c22, c12);
    PlaneEnergy sum;
    add_composed({0.5 * shear_modulus * i.value, 0.5 * shear_modulus, 0}, i, sum);
    add_composed(fibre.at(l.value - 1), l, sum);
    if (active_stress > 0 && l.value > 1) add_composed(active(l.value - 1), l, sum);
    if (second_population > 0) {
      const PlaneInvariant other = population(second_angle, c11, c22, c12);
      const CurveValue w = fibre.at(other.value - 1);
      add_composed(
          {second_population * w.energy, second_population * w.stress, second_population * w.stiffness},
          other, sum);
    }
    return sum;
  }
  double initial_young() const { return 3 * shear_modulus; }
  double initial_poisson() const { return 0.5; }

  bool yields() const { return std::isfinite(fibre.yield_elongation()); }
  // The greater of both populations' elongations over that at which their fibres yield, and its derivatives;
  // zero where neither is longer than at rest.
  PlaneInvariant yield_ratio(double c11, double c22, double c12) const {
    PlaneInvariant most = population(0, c11, c22, c12);
    if (second_population > 0)
      if (const PlaneInvariant other = population(second_angle, c11, c22, c12); other.value > most.value)
        most = other;
    if (most.value <= 1) return {};
    const double yield = fibre.yield_elongation();
    return {(most.value - 1) / yield, most.first / yield, most.second / yield};
  }

 private:
  PlaneInvariant population(double angle, double c11, double c22, double c12) const {
    return stretch_of(fibre_dispersion(splay, splay_out_of_plane, angle), c11, c22, c12);
  }
  // Pre: elongation > 0.
  CurveValue active(double elongation) const {
    const double rest = std::exp(-elongation / kActivation);
    return {active_stress * (elongation + kActivation * std::expm1(-elongation / kActivation)),
            active_stress * (1 - rest), active_stress * rest / kActivation};
  }
};

}  // namespace coapt
