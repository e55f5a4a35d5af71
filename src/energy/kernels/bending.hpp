// Bending of a sheet, lumped in the hinge between two triangles.
//   W = k/2 |a1 - R a2|^2,   k = D |e|^2 / (A1 + A2),   a_i = n_i / (2 A_i)
// n1 = e x s1 and n2 = s2 x e the facets' normals with twice their current areas, A_i the areas at rest, R the
// rotation about the edge by the rest angle theta0, |e| the edge's length at rest, D plate stiffness
// [force x length]. With J_i = |a_i| the facets' area ratios and theta the fold (positive on a ridge) this is
//   W = k ( (J1 - J2)^2/2 + J1 J2 (1 - cos(theta - theta0)) ),
// so that a sheet rolled without stretch to a cylinder has, on the average over directions, the energy
// D/2 kappa^2 per area of plate theory (docs/theory.md tells what was measured on irregular meshes).
// Why not the angle itself: where a membrane that bears no compression gathers, its facets lose their area and
// an angle loses its meaning; its gradient, one over the height, then grows without bound. This law is a
// polynomial but for |e|: finite with all its derivatives wherever the nodes are, also for facets without area
// and at a fold of half a turn. Its price is (J1 - J2)^2, a stiffness of D against gradients of stretch, which
// is of the order of the terms (thickness over length, squared) that plate theory leaves out anyway.
// Nodes: the edge x0 x1, then the corners opposite: x2 in the facet (x0, x1, x2) and x3 in (x1, x0, x3).
// Sources: Grinspun et al. 2003 (hinges), Seung & Nelson 1988 (|n1 - n2|^2 and the factor); area-weighted
// normals and rest angle are our own. Never throws.
#pragma once

#include "core/types.hpp"
#include "energy/kernels/cross_matrix.hpp"
#include "energy/term.hpp"

#include <Eigen/Dense>

#include <cmath>

namespace coapt {

struct BendingHinge {
  static constexpr int kNodes = 4;
  static constexpr std::string_view kType = "bending";
  static constexpr TermRole kRole = TermRole::Internal;

  using Vector12 = Eigen::Vector<double, 12>;
  using Matrix12 = Eigen::Matrix<double, 12, 12>;

  struct Rest {
    double stiffness = 0;      // k [force x length]
    double angle = 0;          // theta0
    double area1 = 0, area2 = 0;  // twice the areas of the facets [length^2]
  };

  // stiffness: D. Pre: the facets are not degenerate at rest (the mesh check refuses those).
  static Rest rest(const Vec3& X0, const Vec3& X1, const Vec3& X2, const Vec3& X3, double stiffness) {
    const Vec3 e = X1 - X0;
    const double area1 = e.cross(X2 - X0).norm(), area2 = e.cross(X3 - X0).norm();
    return {2 * stiffness * e.squaredNorm() / (area1 + area2), angle(X0, X1, X2, X3), area1, area2};
  }

  // theta in [-pi, pi]; 0 where a facet has no area. The sine comes from the height of x3 over the first
  // facet: exact to the rounding of the coordinates in a nearly flat sheet.
  static double angle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
    const Vec3 e = x1 - x0, n1 = e.cross(x2 - x0), n2 = (x3 - x0).cross(e);
    return std::atan2(-e.norm() * n1.dot(x3 - x0), n1.dot(n2));
  }

  static double evaluate(const Rest& rest, const Vector12& x, Vector12* g, Matrix12* H) {
    return evaluate(rest, x, g, H, false);
  }

  // With the positive part of the normals' own curvature in closed form, and without that of the rest angle.
  static double evaluate_projected(const Rest& rest, const Vector12& x, Vector12* g, Matrix12* H) {
    return evaluate(rest, x, g, H, true);
  }

 private:
  using Matrix9 = Eigen::Matrix<double, 9, 9>;  // by the edge vectors e, s1, s2

  static double evaluate(const Rest& rest, const Vector12& x, Vector12* g, Matrix12* H, bool is_projected) {
    const Vec3 e = x.segment<3>(3) - x.segment<3>(0), s1 = x.segment<3>(6) - x.segment<3>(0),
               s2 = x.segment<3>(9) - x.segment<3>(0);
    const Vec3 n1 = e.cross(s1), n2 = s2.cross(e);
    const Vec3 a1 = n1 / rest.area1, a2 = n2 / rest.area2;
    // k |a1 - R a2|^2 / 2 = k |a1 - a2|^2 / 2 + k (1 - cos theta0) a1.a2 + k sin theta0 |e| det / (4 A1 A2)
    const double half_sine = std::sin(0.5 * rest.angle);
    const double k = rest.stiffness, kc = 2 * k * half_sine * half_sine;
    const double ks = k * std::sin(rest.angle) / (rest.area1 * rest.area2);
    const double edge = e.norm(), det = n1.dot(s2);
    const Vec3 difference = a1 - a2;
    const double energy = 0.5 * k * difference.squaredNorm() + kc * a1.dot(a2) + ks * edge * det;
    if (g == nullptr) return energy;

    const Vec3 v1 = (k * difference + kc * a2) / rest.area1;   // dW/dn1 without the last part
    const Vec3 v2 = (-k * difference + kc * a1) / rest.area2;  // dW/dn2
    const Vec3 direction = edge > 0 ? Vec3(e / edge) : Vec3::Zero();
    const Vec3 by_e = s1.cross(s2), by_s1 = s2.cross(e), by_s2 = n1;  // of det
    const Vec3 ge = s1.cross(v1) + v2.cross(s2) + ks * (det * direction + edge * by_e);
    const Vec3 g1 = v1.cross(e) + ks * edge * by_s1, g2 = e.cross(v2) + ks * edge * by_s2;
    g->segment<3>(0) = -(ge + g1 + g2);
    g->segment<3>(3) = ge;
    g->segment<3>(6) = g1;
    g->segment<3>(9) = g2;
    if (H == nullptr) return energy;

    Matrix9 h;
    const Eigen::Matrix3d E = cross_matrix(e), S1 = cross_matrix(s1), S2 = cross_matrix(s2);
    add_squares(rest, k, kc, E, S1, S2, h);
    add_normal_curvature(v1, 3, 1, is_projected, h);
    add_normal_curvature(v2, 6, -1, is_projected, h);
    if (!is_projected && ks != 0) {
      const double c = ks * edge;
      Eigen::Vector<double, 9> slope;
      slope << by_e, by_s1, by_s2;
      const Eigen::Matrix<double, 3, 9> rows = ks * direction * slope.transpose();
      h.topRows<3>() += rows;
      h.leftCols<3>() += rows.transpose();
      if (edge > 0)
        h.block<3, 3>(0, 0) +=
            (ks * det / edge) * (Eigen::Matrix3d::Identity() - direction * direction.transpose());
      h.block<3, 3>(0, 3) -= c * S2;
      h.block<3, 3>(3, 0) += c * S2;
      h.block<3, 3>(0, 6) += c * S1;
      h.block<3, 3>(6, 0) -= c * S1;
      h.block<3, 3>(3, 6) -= c * E;
      h.block<3, 3>(6, 3) += c * E;
    }
    expand(h, *H);
    return energy;
  }

  // k |da1 - da2|^2 + 2 kc da1.da2, positive semidefinite for kc <= k: with a1' = (-[s1], [e], 0) / area1 and
  // a2' = ([s2], 0, -[e]) / area2 by (e, s1, s2), and kc a1.a2 split so.
  static void add_squares(const Rest& rest, double k, double kc, const Eigen::Matrix3d& E,
                          const Eigen::Matrix3d& S1, const Eigen::Matrix3d& S2, Matrix9& h) {
    const double k11 = k / (rest.area1 * rest.area1), k22 = k / (rest.area2 * rest.area2),
                 k12 = (kc - k) / (rest.area1 * rest.area2);
    // Products of cross matrices: [u][v] = v u^T - (u.v) I; transposes change the sign.
    const Eigen::Matrix3d EE = E * E, ES1 = E * S1, ES2 = E * S2, S1S2 = S1 * S2;
    const Eigen::Matrix3d cross = k12 * (S1S2 + S1S2.transpose());
    h.block<3, 3>(0, 0) = -k11 * S1 * S1 - k22 * S2 * S2 + cross;
    h.block<3, 3>(3, 3) = -k11 * EE;
    h.block<3, 3>(6, 6) = -k22 * EE;
    h.block<3, 3>(3, 6) = k12 * EE;
    h.block<3, 3>(6, 3) = k12 * EE;
    h.block<3, 3>(3, 0) = k11 * ES1 - k12 * ES2;
    h.block<3, 3>(6, 0) = k22 * ES2 - k12 * ES1;
    h.block<3, 3>(0, 3) = h.block<3, 3>(3, 0).transpose();
    h.block<3, 3>(0, 6) = h.block<3, 3>(6, 0).transpose();
  }

  // v.n'' of the normal n = turn e x s: blocks -turn [v] and its transpose, with the eigenvalues |v| and -|v|,
  // each twice.
  static void add_normal_curvature(const Vec3& v, int s, double turn, bool is_projected, Matrix9& h) {
    Eigen::Matrix3d block = -turn * cross_matrix(v);
    if (is_projected) {
      const double length = v.norm();
      if (length == 0) return;
      block *= 0.5;
      const Eigen::Matrix3d across = 0.5 * (length * Eigen::Matrix3d::Identity() - v * v.transpose() / length);
      h.block<3, 3>(0, 0) += across;
      h.block<3, 3>(s, s) += across;
    }
    h.block<3, 3>(0, s) += block;
    h.block<3, 3>(s, 0) += block.transpose();
  }

  // From the edge vectors, all of which start at x0, to the nodes.
  static void expand(const Matrix9& h, Matrix12& H) {
    H.bottomRightCorner<9, 9>() = h;
    const Eigen::Matrix<double, 3, 9> sum = -(h.topRows<3>() + h.middleRows<3>(3) + h.bottomRows<3>());
    H.topRightCorner<3, 9>() = sum;
    H.bottomLeftCorner<9, 3>() = sum.transpose();
    H.topLeftCorner<3, 3>() = -(sum.leftCols<3>() + sum.middleCols<3>(3) + sum.rightCols<3>());
  }
};

}  // namespace coapt
