// St. Venant-Kirchhoff membrane on a constant-strain triangle, plane stress.
//   W(x) = A h ( mu |E|^2 + lambda/2 tr(E)^2 ) + A s tr(E),   E = (F^T F - I)/2,  F = D_x D_X^-1
// A rest area [length^2], h thickness [length], lambda = E nu/(1-nu^2) and mu = E/(2(1+nu)) the
// plane-stress Lame moduli [force/length^2], s isotropic prestress resultant (second Piola-Kirchhoff)
// [force/length]. Both shear components are counted: |E|^2 = sum of all four entries, so the law is
// isotropic (Burlina et al. 2010, eq. 13-14, with the shear corrected).
// Compression is resisted and softens: a uniaxial strip buckles in its plane at stretch 1/sqrt(3).
// Source: Bonet & Wood 2008, chapter 6. Never throws.
#pragma once

#include "energy/kernels/cst_state.hpp"
#include "energy/term.hpp"
#include "energy/term_kind.hpp"

namespace coapt {

struct CstStVK {
  static constexpr int kNodes = 3;
  static constexpr std::string_view kType = "cst_stvk";
  static constexpr TermRole kRole = TermRole::Internal;
  static constexpr TermKind kKind = TermKind::Membrane;

  struct Rest {
    Eigen::Matrix2d shape;  // D_X^-1: rest edge vectors in the triangle's plane, inverted [1/length]
    double lambda = 0;      // A h lambda [force x length]
    double mu = 0;          // A h mu [force x length]
    double prestress = 0;   // A s [force x length]
    double volume = 0;  // A h [length^3]; 0 for a membrane of prestress alone, whose stress is not defined
  };

  // young, prestress resultant and thickness as above; poisson in (-1, 0.5]. X: corner positions at rest.
  // Pre: the rest triangle is not degenerate (the mesh check refuses those).
  static Rest rest(const Vec3& X0, const Vec3& X1, const Vec3& X2, double young, double poisson,
                   double thickness, double prestress = 0) {
    const CstShape shape = cst_shape(X0, X1, X2);
    return {shape.inverse, shape.area * thickness * young * poisson / (1 - poisson * poisson),
            shape.area * thickness * young / (2 * (1 + poisson)), shape.area * prestress,
            shape.area * thickness};
  }

  // --- For parameters ---------------------------------------------------------------------------------
  static const Eigen::Matrix2d& shape(const Rest& rest) { return rest.shape; }
  static Rest reshaped(Rest rest, const Corners&, const Corners& X) {
    enlarge(rest, reshape(rest.shape, X));
    return rest;
  }
  static void enlarge(Rest& rest, double ratio) {
    for (double* extensive : {&rest.lambda, &rest.mu, &rest.prestress, &rest.volume}) *extensive *= ratio;
  }
  static void stiffen(Rest& rest, double factor, bool is_size) {
    rest.lambda *= factor;
    rest.mu *= factor;
    if (is_size) rest.volume *= factor;
  }
  static bool has_prestress(const Rest& rest) { return rest.prestress != 0; }

  // The regime is that in which a tension field of the same law would be.
  static MembraneState state(const Rest& rest, const CstVector& x) {
    const CstStrain e = cst_strain(cst_frame(rest.shape, x));
    const CstStress s = stress(rest, e);
    const CstPrincipal p = cst_principal({s.s11, s.s22, s.s12}), strain = cst_principal(e);
    const double volume = rest.volume, shifted = 2 * (rest.lambda + rest.mu);
    const double shift = shifted > 0 ? rest.prestress / shifted : 0;
    const MembraneRegime regime = p.minor >= -1e-14 * shifted ? MembraneRegime::Taut
                                  : strain.major + shift > 0  ? MembraneRegime::Wrinkled
                                                              : MembraneRegime::Slack;
    if (volume == 0) return membrane_state(regime);
    return membrane_state(e, {s.s11 / volume, s.s22 / volume, s.s12 / volume}, regime);
  }

  static double energy(const Rest& rest, const CstStrain& e) {
    const double trace = e.e11 + e.e22;
    return rest.mu * (e.e11 * e.e11 + e.e22 * e.e22 + 2 * e.e12 * e.e12) + 0.5 * rest.lambda * trace * trace +
           rest.prestress * trace;
  }
  static CstStress stress(const Rest& rest, const CstStrain& e) {
    const double mean = rest.lambda * (e.e11 + e.e22) + rest.prestress;
    return {mean + 2 * rest.mu * e.e11, mean + 2 * rest.mu * e.e22, 2 * rest.mu * e.e12};
  }
  static CstTangent tangent(const Rest& rest) {
    const double diagonal = rest.lambda + 2 * rest.mu;
    return {diagonal, diagonal, rest.lambda, rest.mu};
  }

  static double evaluate(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H) {
    const CstFrame frame = cst_frame(rest.shape, x);
    return evaluate(rest, frame, cst_strain(frame), g, H);
  }

  // The same where frame and strain are known.
  static double evaluate(const Rest& rest, const CstFrame& frame, const CstStrain& e, CstVector* g,
                         CstMatrix* H) {
    if (g == nullptr) return energy(rest, e);
    const CstStress s = stress(rest, e);
    cst_gradient(frame, s, *g);
    if (H != nullptr) cst_hessian(frame, s, tangent(rest), *H);
    return energy(rest, e);
  }

  // With the negative eigenvalues of d2W/dF2 set to zero.
  static double evaluate_projected(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H) {
    const CstFrame frame = cst_frame(rest.shape, x);
    const CstStrain e = cst_strain(frame);
    const CstStress s = stress(rest, e);
    cst_gradient(frame, s, *g);
    if (s.s11 + s.s22 >= 0 && s.s11 * s.s22 >= s.s12 * s.s12) {  // tension both ways
      cst_hessian(frame, s, tangent(rest), *H);
    } else {
      const CstPrincipal p = cst_principal(e);
      cst_hessian_projected(turned(frame, p), stress(rest, {p.major, p.minor, 0}), tangent(rest), *H);
    }
    return energy(rest, e);
  }
};

}  // namespace coapt
