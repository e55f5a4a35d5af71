// Tension-field membrane on a constant-strain triangle: St. Venant-Kirchhoff, relaxed. Where the membrane
// would be compressed it wrinkles instead, at no cost: W(E) is the least energy of E + P over all shortenings
// P >= 0 that wrinkles can hide. With the principal strains e1 >= e2, shifted by the prestress,
// e_i = E_i + s/(2 h (lambda + mu)):
//   taut      e2 + nu e1 > 0        W = that of cst_stvk
//   wrinkled  e1 > 0 otherwise      W = A h E/2 e1^2 - W0     tension along the major direction alone
//   slack     e1 <= 0               W = -W0                   no stress
// W0 = A s^2/(2 h (lambda + mu)) makes W vanish at rest; the shift is exact because C : (s/(2h(lambda+mu)) I)
// = s/h I, so prestress only moves the origin of strain. W is continuously differentiable; its Hessian jumps
// at the two borders and is positive semidefinite everywhere: W is convex in E, the stress never compressive.
// r, the residual stiffness, keeps a fraction of the compressive stiffness: (1-r) W + r W_stvk.
// Units as in cst_stvk. Sources: Pipkin 1986, Steigmann 1990. Never throws.
#pragma once

#include "energy/kernels/cst_stvk.hpp"

namespace coapt {

struct CstTensionField {
  static constexpr int kNodes = 3;
  static constexpr std::string_view kType = "cst_tension_field";
  static constexpr TermRole kRole = TermRole::Internal;
  static constexpr TermKind kKind = TermKind::Membrane;

  struct Rest {
    CstStVK::Rest stvk;
    double poisson = 0;
    double uniaxial = 0;  // A h E [force x length]
    double shift = 0;     // s/(2 h (lambda + mu))
    double residual = 0;  // r
  };

  // As CstStVK::rest; residual in [0, 1]. Pre: young, thickness > 0 and poisson in (-1, 0.5].
  static Rest rest(const Vec3& X0, const Vec3& X1, const Vec3& X2, double young, double poisson,
                   double thickness, double prestress = 0, double residual = 0) {
    const CstStVK::Rest stvk = CstStVK::rest(X0, X1, X2, young, poisson, thickness, prestress);
    return {stvk, poisson, 2 * (1 + poisson) * stvk.mu, 0.5 * stvk.prestress / (stvk.lambda + stvk.mu),
            residual};
  }

  // --- For parameters ---------------------------------------------------------------------------------
  static const Eigen::Matrix2d& shape(const Rest& rest) { return rest.stvk.shape; }
  static Rest reshaped(Rest rest, const Corners&, const Corners& X) {
    const double ratio = reshape(rest.stvk.shape, X);
    CstStVK::enlarge(rest.stvk, ratio);
    rest.uniaxial *= ratio;
    return rest;
  }
  static void stiffen(Rest& rest, double factor, bool is_size) {
    CstStVK::stiffen(rest.stvk, factor, is_size);
    rest.uniaxial *= factor;
  }
  static bool has_prestress(const Rest& rest) { return rest.stvk.prestress != 0; }
  static bool relaxes(const Rest&) { return true; }

  static MembraneRegime regime(const Rest& rest, const CstVector& x) {
    return regime(rest, cst_principal(cst_strain(cst_frame(rest.stvk.shape, x))));
  }

  static MembraneState state(const Rest& rest, const CstVector& x) {
    const CstPrincipal p = cst_principal(cst_strain(cst_frame(rest.stvk.shape, x)));
    const MembraneRegime now = regime(rest, p);
    const CstStress s = blend(rest, p, now).stress;
    return membrane_state({p.major, p.minor, 0}, {s.s11 / rest.stvk.volume, s.s22 / rest.stvk.volume, 0},
                          now);
  }

  static double evaluate(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H) {
    return evaluate(rest, x, g, H, false);
  }

  // With the negative eigenvalues of d2W/dF2, which only a residual stiffness can cause, set to zero.
  static double evaluate_projected(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H) {
    return evaluate(rest, x, g, H, true);
  }

 private:
  // Strains this small are round-off; a membrane at rest so counts as taut, and has its stiffness.
  static constexpr double kRoundOff = 1e-14;

  static MembraneRegime regime(const Rest& rest, const CstPrincipal& p) {
    const double major = p.major + rest.shift, minor = p.minor + rest.shift;
    if (minor + rest.poisson * major >= -kRoundOff) return MembraneRegime::Taut;
    return major > 0 ? MembraneRegime::Wrinkled : MembraneRegime::Slack;
  }

  // A law in the frame of the principal strains.
  struct Law {
    double energy = 0;
    CstStress stress;
    CstTangent tangent;
  };

  // Off the taut regime: the uniaxial law, and the share of the full one that is kept.
  static Law blend(const Rest& rest, const CstPrincipal& p, MembraneRegime regime) {
    const CstStVK::Rest& stvk = rest.stvk;
    const CstStrain strain{p.major, p.minor, 0};
    if (regime == MembraneRegime::Taut)
      return {CstStVK::energy(stvk, strain), CstStVK::stress(stvk, strain), CstStVK::tangent(stvk)};
    Law law;
    law.energy = -stvk.prestress * rest.shift;
    if (regime == MembraneRegime::Wrinkled) {
      const double major = p.major + rest.shift, kept = rest.uniaxial * (1 - rest.residual);
      law.energy += 0.5 * rest.uniaxial * major * major;
      law.stress.s11 = kept * major;
      law.tangent.c11 = kept;
      // Turning the major direction; major - minor >= (1 + nu) major > 0.
      law.tangent.shear = 0.5 * kept * major / (p.major - p.minor);
    }
    if (rest.residual == 0) return law;
    const double r = rest.residual;
    const CstStress s = CstStVK::stress(stvk, strain);
    const CstTangent c = CstStVK::tangent(stvk);
    law.energy = (1 - r) * law.energy + r * CstStVK::energy(stvk, strain);
    law.stress.s11 += r * s.s11;
    law.stress.s22 += r * s.s22;
    law.tangent.c11 += r * c.c11;
    law.tangent.c22 += r * c.c22;
    law.tangent.c12 += r * c.c12;
    law.tangent.shear += r * c.shear;
    return law;
  }

  static double evaluate(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H, bool projects) {
    const CstFrame frame = cst_frame(rest.stvk.shape, x);
    const CstStrain e = cst_strain(frame);
    const CstPrincipal p = cst_principal(e);
    const MembraneRegime state = regime(rest, p);
    if (state == MembraneRegime::Taut) return CstStVK::evaluate(rest.stvk, frame, e, g, H);
    const Law law = blend(rest, p, state);
    if (g == nullptr) return law.energy;
    // S = mean I + half (n n^T - t t^T), with n the major direction and t across it.
    const double mean = 0.5 * (law.stress.s11 + law.stress.s22),
                 half = 0.5 * (law.stress.s11 - law.stress.s22);
    cst_gradient(frame, {mean + half * p.cosine, mean - half * p.cosine, half * p.sine}, *g);
    if (H == nullptr) return law.energy;
    if (projects)
      cst_hessian_projected(turned(frame, p), law.stress, law.tangent, *H);
    else
      cst_hessian(turned(frame, p), law.stress, law.tangent, *H);
    return law.energy;
  }
};

}  // namespace coapt
