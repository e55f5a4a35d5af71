// Membrane on a constant-strain triangle of any isotropic law (energy/laws/isotropic.hpp), in plane stress.
//   W = V w(l1, l2),   V = A h volume at rest [length^3], l1 >= l2 the principal stretches
// Relaxed to a tension field it wrinkles instead of being compressed, which costs nothing:
//   taut      dw/dl2 >= 0                 W = V w(l1, l2)
//   wrinkled  l1 > 1, dw/dl2 < 0          W = V w(l1, l), l the width at which dw/dl2 (l1, l) = 0
//   slack     l1 <= 1                     W = 0
// The relaxed W is continuously differentiable, its second derivatives are exact in each regime and jump at
// the borders; the stress is never compressive. Sources: Pipkin 1986 (relaxed energies of membranes),
// Steigmann 1990. Never throws; infinite where an exponential or its derivatives overflow.
#pragma once

#include "energy/kernels/cst_state.hpp"
#include "energy/laws/isotropic.hpp"
#include "energy/term.hpp"
#include "energy/term_kind.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace coapt {

template <typename Law>
struct IsotropicName;
template <>
struct IsotropicName<BilinearLaw> {
  static constexpr std::string_view kType = "cst_bilinear";
};
template <>
struct IsotropicName<NeoHookeanLaw> {
  static constexpr std::string_view kType = "cst_neo_hookean";
};
template <>
struct IsotropicName<ExponentialLaw> {
  static constexpr std::string_view kType = "cst_exponential";
};

template <typename Law>
struct CstIsotropic {
  static constexpr int kNodes = 3;
  static constexpr std::string_view kType = IsotropicName<Law>::kType;
  static constexpr TermRole kRole = TermRole::Internal;
  static constexpr TermKind kKind = TermKind::Membrane;

  struct Rest {
    Eigen::Matrix2d shape;  // D_X^-1 [1/length]
    double volume = 0;      // V
    bool relaxes = true;    // a tension field
    Law law;
  };

  // Pre: the rest triangle is not degenerate (the mesh check refuses those), thickness > 0.
  static Rest rest(const Vec3& X0, const Vec3& X1, const Vec3& X2, const Law& law, double thickness,
                   bool relaxes = true) {
    const CstShape shape = cst_shape(X0, X1, X2);
    return {shape.inverse, shape.area * thickness, relaxes, law};
  }

  // --- For parameters ---------------------------------------------------------------------------------
  static const Eigen::Matrix2d& shape(const Rest& rest) { return rest.shape; }
  static Rest reshaped(Rest rest, const Corners&, const Corners& X) {
    rest.volume *= reshape(rest.shape, X);
    return rest;
  }
  static void stiffen(Rest& rest, double factor, bool /*is_size*/) { rest.volume *= factor; }
  static bool relaxes(const Rest& rest) { return rest.relaxes; }

  static MembraneState state(const Rest& rest, const CstVector& x) {
    const CstPrincipal p = cst_principal(cst_strain(cst_frame(rest.shape, x)));
    const Principal at = respond(rest, p);
    return membrane_state({p.major, p.minor, 0}, at.stress, at.regime, volume_ratio(rest, p, at.regime));
  }

  static double evaluate(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H) {
    return evaluate(rest, x, g, H, false);
  }

  // With the negative eigenvalues of d2W/dF2 set to zero.
  static double evaluate_projected(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H) {
    return evaluate(rest, x, g, H, true);
  }

  // EnergyTerm::limit_stress(). In uniaxial tension the nominal stress is about 2 psi' l.
  static void limit_stress(Rest& rest, const TensionScale& scale) requires requires(Law law) {
    law.invariant.limit;
  }
  {
    const double area = 0.5 / std::abs(rest.shape.determinant());
    rest.law.invariant.limit_stress(0.5 * scale.membrane * area / rest.volume);
  }
  static double raise_limit(Rest& rest, const CstVector& x) requires requires(Law law) {
    law.invariant.limit;
  }
  {
    const CstPrincipal p = cst_principal(cst_strain(cst_frame(rest.shape, x)));
    const double l1 = std::max(stretch(p.major), kThinnest);
    double l2 = std::max(stretch(p.minor), kThinnest);
    if (rest.relaxes) {
      // No strain is greater than that of a sheet as wide as long.
      if (l1 <= 1 || 2 * l1 * l1 + 1 / (l1 * l1 * l1 * l1) - 3 <= rest.law.invariant.limit) return 0;
      l2 = std::max(l2, free_width(rest.law, l1).width);
    }
    return rest.law.invariant.raise_limit(rest.law.strain(l1, l2));
  }

  // The same element with its knee rounded over at least this strain.
  static Rest rounded(Rest rest, double share) requires requires(Law law) { law.knee; }
  {
    rest.law.knee = rest.law.knee.rounded(share);
    return rest;
  }

 private:
  // Stretches that are too small by so little are so by round-off: a membrane at rest counts as taut, and has
  // its stiffness.
  static constexpr double kRoundOff = 1e-14;
  static constexpr double kThinnest = 1e-9;  // stretch below which a collapsed direction is kept finite

  // Of the material, its wrinkles drawn out; 1 where the law says nothing of its thickness.
  static double volume_ratio(const Rest& rest, const CstPrincipal& p, MembraneRegime regime) {
    if constexpr (requires { rest.law.volume_ratio(1.0, 1.0); }) {
      const double l1 = std::max(stretch(p.major), kThinnest), l2 = std::max(stretch(p.minor), kThinnest);
      if (!rest.relaxes || regime == MembraneRegime::Taut) return rest.law.volume_ratio(l1, l2);
      if (regime == MembraneRegime::Wrinkled)
        return rest.law.volume_ratio(l1, free_width(rest.law, l1).width);
    }
    return 1;
  }

  // The law in the frame of the principal strains, per volume.
  struct Principal {
    double energy = 0;
    CstStress stress;
    CstTangent tangent;
    MembraneRegime regime = MembraneRegime::Slack;
  };

  static double stretch(double strain) { return std::sqrt(std::max(0.0, 1 + 2 * strain)); }

  static Principal full(const StretchEnergy& w, double l1, double l2, MembraneRegime regime) {
    const double s1 = w.w1 / l1, s2 = w.w2 / l2;
    const double c11 = (w.w11 - s1) / (l1 * l1), c22 = (w.w22 - s2) / (l2 * l2), c12 = w.w12 / (l1 * l2);
    // Equal stretches leave 0/0; their mean tangent is the limit, with an error of second order.
    constexpr double kEqual = 1e-5;
    const double shear =
        l1 - l2 > kEqual * l1 ? (s1 - s2) / (l1 * l1 - l2 * l2) : 0.25 * (c11 + c22 - 2 * c12);
    return {w.energy, {s1, s2, 0}, {c11, c22, c12, shear}, regime};
  }

  static FreeWidth free_width(const Law& law, double l1) { return found_width(law, l1, law.free_width(l1)); }

  // The width at which a strip stretched by l1 >= 1 is free: dw/dl2 is negative below and positive at l2 =
  // l1. Newton from the law's guess; where it leaves the bracket or gains little, as on the steep side of an
  // exponential, the geometric mean of the bracket.
  static FreeWidth found_width(const Law& law, double l1, const FreeWidth& guess) {
    if (guess.is_exact) return guess;
    double low = kThinnest, high = l1, l2 = std::clamp(guess.width, kThinnest, l1);
    constexpr int kMost = 200;      // steps towards the stress-free width
    constexpr double kLast = 1e-9;  // the error that a step this small leaves is its square
    constexpr double kGain = 0.3;   // of the stress that Newton's step has to leave at most
    double last = std::numeric_limits<double>::infinity();
    for (int k = 0; k < kMost; ++k) {
      const StretchEnergy w = law.evaluate(l1, l2);
      (w.w2 < 0 ? low : high) = l2;
      const double next = l2 - w.w2 / w.w22;
      // A slope that overflows leaves no step.
      if (std::isfinite(w.w22) && std::abs(next - l2) <= kLast * l2) return {next, true};
      const bool is_slow = !(std::abs(w.w2) <= kGain * std::exchange(last, std::abs(w.w2)));
      l2 = next > low && next < high && !is_slow ? next : std::sqrt(low * high);
      if (high - low <= kLast * kLast * high) break;
    }
    return {l2, true};
  }

  static Principal respond(const Rest& rest, const CstPrincipal& p) {
    const double l1 = std::max(stretch(p.major), kThinnest), l2 = std::max(stretch(p.minor), kThinnest);
    if (rest.relaxes && l1 < 1 - kRoundOff) return {};
    const auto is_wrinkled = [&](const FreeWidth& at) { return l2 < at.width * (1 - kRoundOff); };
    // Where the law gives the free width exactly, wrinkles are told by it, without the energy at l2.
    const double length = std::max(l1, 1.0);
    FreeWidth free = rest.relaxes && l2 < 1 ? rest.law.free_width(length) : FreeWidth{};
    if (!free.is_exact || !is_wrinkled(free)) {
      const StretchEnergy trial = rest.law.evaluate(l1, l2);
      if (!rest.relaxes)
        return full(trial, l1, l2,
                    trial.w2 >= 0 ? MembraneRegime::Taut
                    : l1 > 1      ? MembraneRegime::Wrinkled
                                  : MembraneRegime::Slack);
      if (trial.w2 >= 0) return full(trial, l1, l2, MembraneRegime::Taut);
      free = l2 < 1 ? found_width(rest.law, length, free) : free_width(rest.law, length);
      if (!is_wrinkled(free)) return full(trial, l1, l2, MembraneRegime::Taut);
    }
    if (l1 <= 1) return {};
    const StretchEnergy w = rest.law.evaluate(l1, free);
    Principal wrinkled{w.energy, {w.w1 / l1, 0, 0}, {}, MembraneRegime::Wrinkled};
    const double along = w.w11 - w.w12 * (w.w12 / w.w22);
    wrinkled.tangent.c11 = (along - wrinkled.stress.s11) / (l1 * l1);
    // Turning the major direction; l1 > 1 > l2.
    wrinkled.tangent.shear = wrinkled.stress.s11 / (l1 * l1 - l2 * l2);
    return wrinkled;
  }

  static double evaluate(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H, bool projects) {
    const CstFrame frame = cst_frame(rest.shape, x);
    const CstPrincipal p = cst_principal(cst_strain(frame));
    Principal at = respond(rest, p);
    const double V = rest.volume;
    const CstTangent& c = at.tangent;
    // Next to where the energy overflows its derivatives have.
    if (overflows(frame, V * (std::abs(c.c11) + std::abs(c.c22) + std::abs(c.c12) + std::abs(c.shear))))
      at.energy = std::numeric_limits<double>::infinity();
    if (g == nullptr) return V * at.energy;
    // S = mean I + half (n n^T - t t^T), with n the major direction and t across it.
    const double mean = 0.5 * V * (at.stress.s11 + at.stress.s22),
                 half = 0.5 * V * (at.stress.s11 - at.stress.s22);
    cst_gradient(frame, {mean + half * p.cosine, mean - half * p.cosine, half * p.sine}, *g);
    if (H == nullptr) return V * at.energy;
    const CstStress stress{V * at.stress.s11, V * at.stress.s22, 0};
    const CstTangent tangent{V * at.tangent.c11, V * at.tangent.c22, V * at.tangent.c12,
                             V * at.tangent.shear};
    if (projects)
      cst_hessian_projected(turned(frame, p), stress, tangent, *H);
    else
      cst_hessian(turned(frame, p), stress, tangent, *H);
    return V * at.energy;
  }
};

using CstBilinear = CstIsotropic<BilinearLaw>;
using CstNeoHookean = CstIsotropic<NeoHookeanLaw>;
using CstExponential = CstIsotropic<ExponentialLaw>;

}  // namespace coapt
