// The stresses of one triangle, for reports, from its second Piola-Kirchhoff stress S.
//   sigma = F S F^T / J   Cauchy (true) stress, force over the deformed cross-section, in the deformed plane
//   P = F S               first Piola-Kirchhoff (nominal) stress, force over the cross-section at rest
// J = det F_2 l3 is the ratio of volumes: det F_2 that of the areas, l3 the stretch of the thickness. With
// the polar decomposition F = R U the principal values of sigma are those of U S U / J, whatever the
// rotation. Where wrinkles take up a width, S pulls along one direction and U S U is the same with that width
// and without it; J is that of the material. Source: Holzapfel 2000, chapter 3. Never throws.
#pragma once

#include "energy/kernels/cst.hpp"

#include <cmath>

namespace coapt {

// U of U^2 = C, by the theorem of Cayley and Hamilton. Pre: C positive semidefinite.
inline Eigen::Matrix2d root_of(const Eigen::Matrix2d& C) {
  const double det = std::sqrt(std::max(0.0, C.determinant())), trace = std::sqrt(C.trace() + 2 * det);
  if (!(trace > 0)) return Eigen::Matrix2d::Zero();
  return (C + det * Eigen::Matrix2d::Identity()) / trace;
}

// Of a strain and its stress S per volume at rest, in one frame of the rest plane; J as above. The principal
// values of P are the singular values of U S, negative where it pushes: eigenvalues where S and U share their
// axes, as in every isotropic law.
inline MembraneState membrane_state(const CstStrain& e, const CstStress& s, MembraneRegime regime,
                                    double J = 1) {
  Eigen::Matrix2d C, S;
  C << 1 + 2 * e.e11, 2 * e.e12, 2 * e.e12, 1 + 2 * e.e22;
  S << s.s11, s.s12, s.s12, s.s22;
  const Eigen::Matrix2d U = root_of(C), P = U * S, tau = P * U;
  const CstPrincipal second = cst_principal({s.s11, s.s22, s.s12});
  const CstPrincipal kirchhoff = cst_principal({tau(0, 0), tau(1, 1), 0.5 * (tau(0, 1) + tau(1, 0))});
  const double mean = 0.5 * std::hypot(P(0, 0) + P(1, 1), P(1, 0) - P(0, 1));
  const double radius = 0.5 * std::hypot(P(0, 0) - P(1, 1), P(1, 0) + P(0, 1));
  const double sign = P.trace() < 0 ? -1 : 1;
  MembraneState state;
  state.stress = {second.major, second.minor};
  state.regime = regime;
  state.cauchy = Eigen::Vector2d(kirchhoff.major, kirchhoff.minor) / J;
  state.first_piola = {sign * mean + radius, sign * mean - radius};
  return state;
}

// Of a membrane without a thickness, which has forces and no stress.
inline MembraneState membrane_state(MembraneRegime regime) {
  MembraneState state;
  state.regime = regime;
  state.has_thickness = false;
  return state;
}

}  // namespace coapt
