// Nonlinear laws of a line in uniaxial tension: energy per volume at rest, nominal stress (force per area at
// rest) and its slope, as functions of the elongation e = l - 1 >= 0, where the stress vanishes at e = 0.
#pragma once

#include "energy/laws/crimped_fibre.hpp"

#include <array>
#include <cmath>

namespace coapt {

// Stress E_pre e up to the knee, slope E_post beyond. Source: Hammer et al. 2008.
struct BilinearLine {
  double young = 0;   // E_pre [stress]
  BilinearKnee knee;  // modulus E_post - E_pre

  CurveValue at(double e) const {
    const CurveValue past = knee.at(e);
    return {0.5 * young * e * e + past.energy, young * e + past.stress, young + past.stiffness};
  }
};

// Incompressible Ogden law of up to three terms in uniaxial tension:
//   W = sum 2 mu_i/alpha_i^2 (l^alpha_i + 2 l^(-alpha_i/2) - 3)
// mu_i [stress]; the initial shear modulus is their sum. Source: Ogden 1972, in the form of finite-element
// codes. alpha_i != 0 where mu_i != 0.
struct OgdenLine {
  static constexpr int kTerms = 3;
  std::array<double, kTerms> mu{}, alpha{};

  CurveValue at(double e) const {
    const double ln = std::log1p(e), l = 1 + e;
    CurveValue sum;
    for (int k = 0; k < kTerms; ++k) {
      if (mu[k] == 0) continue;
      const double a = alpha[k] * ln, grown = std::expm1(a), shrunk = std::expm1(-0.5 * a);
      const double factor = 2 * mu[k] / alpha[k];
      sum.energy += factor / alpha[k] * sum_of_powers(a, grown, shrunk);
      sum.stress += factor * (grown - shrunk) / l;
      sum.stiffness +=
          factor * ((alpha[k] - 1) * (1 + grown) + (0.5 * alpha[k] + 1) * (1 + shrunk)) / (l * l);
    }
    return sum;
  }

 private:
  // exp(a) + 2 exp(-a/2) - 3, whose first terms cancel where a is small.
  static double sum_of_powers(double a, double grown, double shrunk) {
    constexpr double kSmall = 0.05;  // exponent below which ten terms of the series are exact to round-off
    if (std::abs(a) > kSmall) return grown + 2 * shrunk;
    double term = 1, half = 2, sum = 0;
    for (int k = 1; k <= 10; ++k) {
      term *= a / k;
      half *= -0.5;
      if (k > 1) sum += term * (1 + half);
    }
    return sum;
  }
};

// Tendon-like: an exponential toe until all fibres are recruited, then a straight line:
//   s = E (e1 - e0) (exp(b e) - 1)/(exp(b e1) - 1) for e < e1,   s = E (e - e0) beyond
// E modulus [stress], e1 strain of full recruitment, e0 < e1 where the line meets zero stress, b > 0 exponent
// of the toe. The stress is continuous; its slope is where b (e1 - e0) = 1 - exp(-b e1), as in fits of it.
// Source: Kaiser et al. 2019.
struct ToeLine {
  double young = 0, intercept = 0, recruited = 0, exponent = 1;

  CurveValue at(double e) const {
    // Relative to the end of the toe, where no exponent overflows.
    const double end = young * (recruited - intercept), all = -std::expm1(-exponent * recruited);
    const auto share = [&](double at) {
      return std::exp(exponent * (at - recruited)) * -std::expm1(-exponent * at) / all;
    };
    const auto toe_energy = [&](double at) {
      return end * (share(at) / exponent - at / std::expm1(exponent * recruited));
    };
    if (e < recruited)
      return {toe_energy(e), end * share(e), end * exponent * std::exp(exponent * (e - recruited)) / all};
    const double past = e - recruited;
    return {toe_energy(recruited) + end * past + 0.5 * young * past * past, end + young * past, young};
  }
};

// A bundle of crimped fibres in an incompressible neo-Hookean matrix of this shear modulus, W = mu/2 (I1 -
// 3): without it a chord whose fibres are long in their crimp has next to no stiffness. Source: Toma et al.
// 2016, eq. 1 and section 2.5, in uniaxial tension.
struct CrimpedLine {
  CrimpedFibre fibre;
  double shear_modulus = 0;  // mu [stress]

  // At which its fibres yield; infinite where they never do.
  double yield_elongation() const { return fibre.yield_elongation(); }

  CurveValue at(double e) const {
    const CurveValue fibres = fibre.at(e), matrix = OgdenLine{{shear_modulus}, {2}}.at(e);
    return {fibres.energy + matrix.energy, fibres.stress + matrix.stress,
            fibres.stiffness + matrix.stiffness};
  }
};

}  // namespace coapt
