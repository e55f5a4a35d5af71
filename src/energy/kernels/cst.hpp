// What every membrane law on the constant-strain triangle shares: strain, and how stress and tangent become
// forces and stiffness of the three corners.
//   F = D_x D_X^-1 = (f1, f2) (3x2),   E = (F^T F - I)/2,   P = F S,
//   d2W = dF : (dF S) + dE : C : dE    with S the second Piola-Kirchhoff stress and C = dS/dE.
#pragma once

#include "core/types.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>

namespace coapt {

using CstVector = Eigen::Vector<double, 9>;
using CstMatrix = Eigen::Matrix<double, 9, 9>;

// Shape of a triangle at rest.
struct CstShape {
  Eigen::Matrix2d inverse;  // D_X^-1: rest edge vectors in the triangle's plane, inverted [1/length]
  double area = 0;          // [length^2]
};

// The first axis of the rest frame lies along the projection of `axis` onto the triangle's plane.
// Pre: the triangle is not degenerate (the mesh check refuses those); axis is not normal to it.
inline CstShape cst_shape(const Vec3& X0, const Vec3& X1, const Vec3& X2, const Vec3& axis) {
  const Vec3 e1 = X1 - X0, e2 = X2 - X0, normal = e1.cross(e2);
  const Vec3 t2 = normal.cross(axis).normalized();
  const Vec3 t1 = t2.cross(normal).normalized();
  Eigen::Matrix2d edges;
  edges << e1.dot(t1), e2.dot(t1), e1.dot(t2), e2.dot(t2);
  return {edges.inverse(), 0.5 * normal.norm()};
}

// The same with the first axis along the first edge.
inline CstShape cst_shape(const Vec3& X0, const Vec3& X1, const Vec3& X2) {
  return cst_shape(X0, X1, X2, X1 - X0);
}

// Corners of an element at rest; a triangle has three of them.
using Corners = std::array<Vec3, 4>;

// Edge vectors of the triangle at rest.
inline Eigen::Matrix<double, 3, 2> rest_edges(const Corners& X) {
  Eigen::Matrix<double, 3, 2> edges;
  edges << X[1] - X[0], X[2] - X[0];
  return edges;
}

// Gives a triangle of the shape D_X^-1 the corners X, its first axis being a line that is drawn on it.
// Returns its area over that before.
inline double reshape(Eigen::Matrix2d& inverse, const Corners& X) {
  const CstShape shape = cst_shape(X[0], X[1], X[2], rest_edges(X) * inverse.col(0));
  const double ratio = shape.area * 2 * std::abs(inverse.determinant());
  inverse = shape.inverse;
  return ratio;
}

// How a membrane that does not resist compression carries its load.
enum class MembraneRegime { Slack = 0, Wrinkled = 1, Taut = 2 };

// Stress of one triangle, for reports.
struct MembraneState {
  Eigen::Vector2d stress = Eigen::Vector2d::Zero();  // principal second Piola-Kirchhoff, larger first [MPa]
  MembraneRegime regime = MembraneRegime::Slack;     // of a law that resists compression: what a tension
                                                     // field would be
  Eigen::Vector2d cauchy = Eigen::Vector2d::Zero();  // principal Cauchy, larger first [MPa]
  Eigen::Vector2d first_piola = Eigen::Vector2d::Zero();  // principal first Piola-Kirchhoff, larger first
                                                          // [MPa], see membrane_state()
  bool has_thickness = true;                              // else no stress is defined, and all are zero
};

// An orthonormal frame of the rest plane: the shape gradients w (row k: edge vector k+1), the columns of F,
// and in it stress and tangent.
struct CstFrame {
  Eigen::Matrix2d w;
  Vec3 f1, f2;
};

struct CstStrain {
  double e11 = 0, e22 = 0, e12 = 0;
};

// Second Piola-Kirchhoff stress (times rest area and thickness) [force x length].
struct CstStress {
  double s11 = 0, s22 = 0, s12 = 0;
};

// Derivatives of that stress in a frame in which shear and stretch do not couple.
struct CstTangent {
  double c11 = 0, c22 = 0, c12 = 0;  // dS11/dE11, dS22/dE22, dS11/dE22
  double shear = 0;                  // dS12/d(2 E12)
};

inline CstFrame cst_frame(const Eigen::Matrix2d& w, const CstVector& x) {
  const Vec3 d1 = x.segment<3>(3) - x.segment<3>(0), d2 = x.segment<3>(6) - x.segment<3>(0);
  return {w, d1 * w(0, 0) + d2 * w(1, 0), d1 * w(0, 1) + d2 * w(1, 1)};
}

inline CstStrain cst_strain(const CstFrame& frame) {
  return {0.5 * (frame.f1.dot(frame.f1) - 1), 0.5 * (frame.f2.dot(frame.f2) - 1),
          0.5 * frame.f1.dot(frame.f2)};
}

// Principal strains, larger first, and twice the angle from the first axis to the major direction.
struct CstPrincipal {
  double major = 0, minor = 0;
  double cosine = 1, sine = 0;  // of the double angle

  // Of the major strain, a unit vector.
  Eigen::Vector2d direction() const {
    // Half the angle, from the half that is not small.
    double c = std::sqrt(0.5 * (1 + std::abs(cosine))), s = 0.5 * sine / c;
    if (cosine < 0) std::swap(c, s);
    return {c, s};
  }
};

inline CstPrincipal cst_principal(const CstStrain& e) {
  const double mean = 0.5 * (e.e11 + e.e22), half = 0.5 * (e.e11 - e.e22);
  const double radius = std::sqrt(half * half + e.e12 * e.e12);
  if (radius == 0) return {mean, mean, 1, 0};
  return {mean + radius, mean - radius, half / radius, e.e12 / radius};
}

// The same triangle in the frame of the principal strains.
inline CstFrame turned(const CstFrame& frame, const CstPrincipal& p) {
  const Eigen::Vector2d major = p.direction();
  const double c = major[0], s = major[1];
  Eigen::Matrix2d w;
  w.col(0) = frame.w.col(0) * c + frame.w.col(1) * s;
  w.col(1) = frame.w.col(1) * c - frame.w.col(0) * s;
  return {w, frame.f1 * c + frame.f2 * s, frame.f2 * c - frame.f1 * s};
}

// May the Hessian overflow? tangent: the sum of its absolute values, times rest area and thickness.
inline bool overflows(const CstFrame& frame, double tangent) {
  // With room for the sums of products that an entry has.
  const double entry =
      100 * tangent * frame.w.squaredNorm() * (frame.f1.squaredNorm() + frame.f2.squaredNorm());
  return !std::isfinite(entry);
}

inline void cst_gradient(const CstFrame& frame, const CstStress& s, CstVector& g) {
  const Eigen::Matrix2d& w = frame.w;
  const Vec3 p1 = frame.f1 * s.s11 + frame.f2 * s.s12, p2 = frame.f1 * s.s12 + frame.f2 * s.s22;
  const Vec3 g1 = p1 * w(0, 0) + p2 * w(0, 1), g2 = p1 * w(1, 0) + p2 * w(1, 1);
  g.segment<3>(0) = -g1 - g2;
  g.segment<3>(3) = g1;
  g.segment<3>(6) = g2;
}

// From the blocks d2W / df_a df_b of the columns of F to those of the corners.
inline void cst_hessian(const Eigen::Matrix2d& w, const Eigen::Matrix3d& k11, const Eigen::Matrix3d& k12,
                        const Eigen::Matrix3d& k22, CstMatrix& H) {
  const Eigen::Matrix3d k_sum = k12 + k12.transpose();
  const auto diagonal = [&](double a, double b) -> Eigen::Matrix3d {
    return (a * a) * k11 + (a * b) * k_sum + (b * b) * k22;
  };
  const Eigen::Matrix3d h11 = diagonal(w(0, 0), w(0, 1)), h22 = diagonal(w(1, 0), w(1, 1));
  const Eigen::Matrix3d h12 = (w(0, 0) * w(1, 0)) * k11 + (w(0, 0) * w(1, 1)) * k12 +
                              (w(0, 1) * w(1, 0)) * k12.transpose() + (w(0, 1) * w(1, 1)) * k22;
  H.block<3, 3>(3, 3) = h11;
  H.block<3, 3>(6, 6) = h22;
  H.block<3, 3>(3, 6) = h12;
  H.block<3, 3>(6, 3) = h12.transpose();
  H.block<3, 3>(3, 0) = -h11 - h12;
  H.block<3, 3>(6, 0) = -h22 - h12.transpose();
  H.block<3, 3>(0, 3) = H.block<3, 3>(3, 0).transpose();
  H.block<3, 3>(0, 6) = H.block<3, 3>(6, 0).transpose();
  H.block<3, 3>(0, 0) = (h11 + h22) + (h12 + h12.transpose());
}

inline void cst_hessian(const CstFrame& frame, const CstStress& s, const CstTangent& c, CstMatrix& H) {
  const Eigen::Matrix3d f11 = frame.f1 * frame.f1.transpose(), f22 = frame.f2 * frame.f2.transpose(),
                        f12 = frame.f1 * frame.f2.transpose();
  Eigen::Matrix3d k11 = c.c11 * f11 + c.shear * f22, k22 = c.c22 * f22 + c.shear * f11,
                  k12 = c.c12 * f12 + c.shear * f12.transpose();
  k11.diagonal().array() += s.s11;
  k22.diagonal().array() += s.s22;
  k12.diagonal().array() += s.s12;
  cst_hessian(frame.w, k11, k12, k22, H);
}

// The same with any tangent, rows and columns (E11, E22, 2 E12).
inline void cst_hessian(const CstFrame& frame, const CstStress& s, const Eigen::Matrix3d& c, CstMatrix& H) {
  const Vec3 &f1 = frame.f1, &f2 = frame.f2;
  // dE11 = f1 . df1, dE22 = f2 . df2, 2 dE12 = f2 . df1 + f1 . df2.
  Eigen::Matrix<double, 3, 3> d1, d2;
  d1 << f1.transpose(), Vec3::Zero().transpose(), f2.transpose();
  d2 << Vec3::Zero().transpose(), f2.transpose(), f1.transpose();
  const Eigen::Matrix3d c1 = c * d1, c2 = c * d2;
  Eigen::Matrix3d k11 = d1.transpose() * c1, k12 = d1.transpose() * c2, k22 = d2.transpose() * c2;
  k11.diagonal().array() += s.s11;
  k22.diagonal().array() += s.s22;
  k12.diagonal().array() += s.s12;
  cst_hessian(frame.w, k11, k12, k22, H);
}

// The nearest positive semidefinite matrix [[a, b], [b, c]].
struct Symmetric2 {
  double a = 0, b = 0, c = 0;
};
inline Symmetric2 clamped(const Symmetric2& m) {
  const double mean = 0.5 * (m.a + m.c), half = 0.5 * (m.a - m.c);
  const double radius = std::sqrt(half * half + m.b * m.b);
  if (mean - radius >= 0) return m;
  if (mean + radius <= 0) return {};
  // The larger eigenvalue times its projector; radius > |mean| >= 0 here.
  const double factor = 0.5 * (mean + radius) / radius;
  return {factor * (radius + half), factor * m.b, factor * (radius - half)};
}

// As cst_hessian in the frame of the principal strains, with the negative eigenvalues of d2W/dF2 set to
// zero. In that frame F = (s1 u1, s2 u2), s1 >= s2, and the eigenspaces are known: the stretches of u1 and
// u2 (a 2x2 block), the symmetric and skew exchange of u1 and u2, and the tilts of f1 and f2 out of the
// plane, whose eigenvalues are the stresses. Adapted to 3x2 from Smith et al. 2019 (analytic eigensystems
// for isotropic distortion energies). Pre: s.s12 = 0, and `shear` = (S1 - S2) / (2 (E1 - E2)).
inline void cst_hessian_projected(const CstFrame& frame, const CstStress& s, const CstTangent& c,
                                  CstMatrix& H) {
  // With tension both ways and a tangent that is positive nothing is negative.
  if (s.s11 >= 0 && s.s22 >= 0 && c.c11 >= 0 && c.c11 * c.c22 >= c.c12 * c.c12 && c.shear >= 0)
    return cst_hessian(frame, s, c, H);
  const double s1 = frame.f1.norm(), s2 = frame.f2.norm();
  const Vec3 u1 = s1 > 0 ? Vec3(frame.f1 / s1) : Vec3(Vec3::UnitX());
  Vec3 u2 = frame.f2 - u1.dot(frame.f2) * u1;
  // A collapsed direction has no u2: any one will do, for the two are then alike.
  u2 = u2.squaredNorm() > 0 ? u2.normalized() : u1.unitOrthogonal();
  const Symmetric2 stretch = clamped({s.s11 + c.c11 * s1 * s1, c.c12 * s1 * s2, s.s22 + c.c22 * s2 * s2});
  const double mean = 0.5 * (s.s11 + s.s22);
  const double symmetric = std::max(0.0, mean + 0.5 * c.shear * (s1 + s2) * (s1 + s2));
  const double skew = std::max(0.0, mean + 0.5 * c.shear * (s1 - s2) * (s1 - s2));
  const double same = 0.5 * (symmetric + skew), cross = 0.5 * (symmetric - skew);
  const Eigen::Matrix3d u11 = u1 * u1.transpose(), u22 = u2 * u2.transpose(), u12 = u1 * u2.transpose();
  const Eigen::Matrix3d normal = Eigen::Matrix3d::Identity() - u11 - u22;
  cst_hessian(frame.w, stretch.a * u11 + same * u22 + std::max(0.0, s.s11) * normal,
              stretch.b * u12 + cross * u12.transpose(),
              stretch.c * u22 + same * u11 + std::max(0.0, s.s22) * normal, H);
}

}  // namespace coapt
