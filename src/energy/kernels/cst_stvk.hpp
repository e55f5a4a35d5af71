// St. Venant-Kirchhoff membrane on a constant-strain triangle, plane stress.
//   W(x) = A h ( mu |E|^2 + lambda/2 tr(E)^2 ) + A s tr(E),   E = (F^T F - I)/2,  F = D_x D_X^-1
// A rest area [length^2], h thickness [length], lambda = E nu/(1-nu^2) and mu = E/(2(1+nu)) the
// plane-stress Lame moduli [force/length^2], s isotropic prestress resultant (second Piola-Kirchhoff)
// [force/length]. Both shear components are counted: |E|^2 = sum of all four entries, so the law is
// isotropic (Burlina et al. 2010, eq. 13-14, with the shear corrected).
// Compression is resisted and softens: a uniaxial strip buckles in its plane at stretch 1/sqrt(3).
// Source: Bonet & Wood 2008, chapter 6. Never throws.
#pragma once

#include "core/types.hpp"
#include "energy/term.hpp"

#include <Eigen/Dense>

namespace coapt {

struct CstStVK {
  static constexpr int kNodes = 3;
  static constexpr std::string_view kType = "cst_stvk";
  static constexpr TermRole kRole = TermRole::Internal;

  struct Rest {
    Eigen::Matrix2d shape;  // D_X^-1: rest edge vectors in the triangle's plane, inverted [1/length]
    double lambda = 0;      // A h lambda [force x length]
    double mu = 0;          // A h mu [force x length]
    double prestress = 0;   // A s [force x length]
  };

  // young, prestress resultant and thickness as above; poisson in (-1, 0.5]. X: corner positions at rest.
  // Pre: the rest triangle is not degenerate (the mesh check refuses those).
  static Rest rest(const Vec3& X0, const Vec3& X1, const Vec3& X2, double young, double poisson,
                   double thickness, double prestress = 0) {
    const Vec3 e1 = X1 - X0, e2 = X2 - X0;
    const Vec3 t1 = e1.normalized();
    const Vec3 t2 = e1.cross(e2).cross(e1).normalized();
    Eigen::Matrix2d edges;
    edges << e1.dot(t1), e2.dot(t1), 0, e2.dot(t2);
    const double area = 0.5 * e1.cross(e2).norm();
    return {edges.inverse(), area * thickness * young * poisson / (1 - poisson * poisson),
            area * thickness * young / (2 * (1 + poisson)), area * prestress};
  }

  static double evaluate(const Rest& rest, const Eigen::Vector<double, 9>& x, Eigen::Vector<double, 9>* g,
                         Eigen::Matrix<double, 9, 9>* H) {
    const Vec3 d1 = x.segment<3>(3) - x.segment<3>(0), d2 = x.segment<3>(6) - x.segment<3>(0);
    const Eigen::Matrix2d& w = rest.shape;
    const Vec3 f1 = d1 * w(0, 0) + d2 * w(1, 0), f2 = d1 * w(0, 1) + d2 * w(1, 1);  // columns of F
    const double e11 = 0.5 * (f1.dot(f1) - 1), e22 = 0.5 * (f2.dot(f2) - 1), e12 = 0.5 * f1.dot(f2);
    const double trace = e11 + e22;
    const double energy = rest.mu * (e11 * e11 + e22 * e22 + 2 * e12 * e12) +
                          0.5 * rest.lambda * trace * trace + rest.prestress * trace;
    if (g == nullptr) return energy;

    // Stress (times A h) and its force on the two edge vectors.
    const double s11 = rest.lambda * trace + 2 * rest.mu * e11 + rest.prestress;
    const double s22 = rest.lambda * trace + 2 * rest.mu * e22 + rest.prestress;
    const double s12 = 2 * rest.mu * e12;
    const Vec3 p1 = f1 * s11 + f2 * s12, p2 = f1 * s12 + f2 * s22;
    const Vec3 g1 = p1 * w(0, 0) + p2 * w(0, 1), g2 = p1 * w(1, 0) + p2 * w(1, 1);
    g->segment<3>(0) = -g1 - g2;
    g->segment<3>(3) = g1;
    g->segment<3>(6) = g2;
    if (H == nullptr) return energy;

    // B = dE/dx in Voigt order (E11, E22, 2 E12); H = B^T D B + (w_a . S w_b) I.
    Eigen::Matrix<double, 3, 2> grads;  // shape gradient of each node
    grads << -w(0, 0) - w(1, 0), -w(0, 1) - w(1, 1), w(0, 0), w(0, 1), w(1, 0), w(1, 1);
    Eigen::Matrix<double, 3, 9> B;
    for (int a = 0; a < 3; ++a) {
      B.block<1, 3>(0, 3 * a) = grads(a, 0) * f1.transpose();
      B.block<1, 3>(1, 3 * a) = grads(a, 1) * f2.transpose();
      B.block<1, 3>(2, 3 * a) = grads(a, 1) * f1.transpose() + grads(a, 0) * f2.transpose();
    }
    Eigen::Matrix3d D;
    const double diagonal = rest.lambda + 2 * rest.mu;
    D << diagonal, rest.lambda, 0, rest.lambda, diagonal, 0, 0, 0, rest.mu;
    H->noalias() = B.transpose() * (D * B);
    Eigen::Matrix2d S;
    S << s11, s12, s12, s22;
    const Eigen::Matrix3d geometric = grads * S * grads.transpose();
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        for (int c = 0; c < 3; ++c) (*H)(3 * a + c, 3 * b + c) += geometric(a, b);
    return energy;
  }
};

}  // namespace coapt
