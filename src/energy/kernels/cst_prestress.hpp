// Membrane of prescribed anisotropic prestress on a constant-strain triangle: form finding of tents and
// sails.
//   W(x) = A/2 S : C = A/2 (s1 |f1|^2 + s2 |f2|^2),   F = D_x D_X^-1 = (f1, f2),   C = F^T F
// A rest area [length^2]; S the second Piola-Kirchhoff stress resultant, constant, with the principal values
// s1 along the warp and s2 along the weft across it [force/length]. The warp is the first axis of the rest
// frame.
//
// W is quadratic in the positions and, for s1, s2 >= 0, convex and never negative: without follower loads the
// equilibrium is one linear solve and unique where the frame holds it. It is the energy of a cable net of the
// force densities q_k that A S = sum q_k E_k E_k^T gives to the edges E_k of the triangle (Schek 1974), sum
// q_k l_k^2/2. It does not vanish at rest, where only balanced prestress has no force.
// S is prescribed in the shape at rest. The resultant in the closed shape is F S F^T / J; where that is to be
// prescribed, the closed shape is taken as the next one at rest until both agree (updated reference strategy,
// Bletzinger & Ramm 1999). s1 = s2 on a shape at rest that is the closed one is a film of constant tension.
// The force of a node is the same whatever the strain: nothing resists stretch beside the frame. Never
// throws.
#pragma once

#include "energy/kernels/cst_state.hpp"
#include "energy/term.hpp"
#include "energy/term_kind.hpp"

namespace coapt {

struct CstPrestress {
  static constexpr int kNodes = 3;
  static constexpr std::string_view kType = "cst_prestress";
  static constexpr TermRole kRole = TermRole::Internal;
  static constexpr TermKind kKind = TermKind::Membrane;

  struct Rest {
    Eigen::Matrix2d shape;  // D_X^-1, first axis along the warp [1/length]
    double warp = 0;        // A s1 [force x length]
    double weft = 0;        // A s2 [force x length]
    double volume = 0;      // A h [length^3]; 0 without a thickness: stress is then not defined
  };

  // direction: its projection onto the triangle's plane is the warp. Pre: the rest triangle is not
  // degenerate, direction not normal to it; warp and weft resultants and thickness as above, none of them
  // negative.
  static Rest rest(const Vec3& X0, const Vec3& X1, const Vec3& X2, const Vec3& direction, double warp,
                   double weft, double thickness = 0) {
    const CstShape shape = cst_shape(X0, X1, X2, direction);
    return {shape.inverse, shape.area * warp, shape.area * weft, shape.area * thickness};
  }

  // --- For parameters -----------------------------------------------------------------------------------
  static const Eigen::Matrix2d& shape(const Rest& rest) { return rest.shape; }
  static Rest reshaped(Rest rest, const Corners&, const Corners& X) {
    const double ratio = reshape(rest.shape, X);
    for (double* extensive : {&rest.warp, &rest.weft, &rest.volume}) *extensive *= ratio;
    return rest;
  }

  static MembraneState state(const Rest& rest, const CstVector& x) {
    if (rest.volume == 0) return membrane_state(MembraneRegime::Taut);
    return membrane_state(cst_strain(cst_frame(rest.shape, x)),
                          {rest.warp / rest.volume, rest.weft / rest.volume, 0}, MembraneRegime::Taut);
  }

  static double evaluate(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H) {
    const CstFrame frame = cst_frame(rest.shape, x);
    const CstStress s{rest.warp, rest.weft, 0};
    if (g != nullptr) cst_gradient(frame, s, *g);
    if (H != nullptr) cst_hessian(frame, s, CstTangent{}, *H);
    return 0.5 * (rest.warp * frame.f1.squaredNorm() + rest.weft * frame.f2.squaredNorm());
  }

  // No resultant is negative, so neither is the exact Hessian.
  static double evaluate_projected(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H) {
    return evaluate(rest, x, g, H);
  }
};

}  // namespace coapt
