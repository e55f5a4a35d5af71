// Bending of a sheet, lumped in the hinge between two triangles.
//   W = k/2 |r|^2,   r = cos(theta0/2) (m1 + m2) + sin(theta0/2) (n1 + n2),   k = D |e|^2 / (A1 + A2)
// n1, n2 area vectors of the facets over twice their areas at rest; m1, m2 the vectors from the edge to the
// opposite corners, from the points of the edge that were their feet at rest, over the heights at rest. While
// the facets keep their shape all four are unit vectors and |r| = 2 |sin((theta - theta0)/2)|, with theta the
// signed angle between the normals (positive on a ridge), theta0 that at rest: the angle itself for small
// changes, and finite in a full fold. |e| is the length of the edge and A1, A2 areas of the facets at rest, D
// plate stiffness [force x length].
//
// W is a polynomial in the positions, of degree two where the sheet is flat at rest: smooth everywhere, also
// where a facet collapses. The angle itself has no limit there, and a membrane that does not resist
// compression is drawn to such states. In return a change of shape counts: strain that varies between the
// facets costs D |grad F|^2/2, less than the membrane's own energy by (h/L)^2/12, and the curvature of a
// stretched sheet is measured along its length at rest.
//
// A sheet rolled to a cylinder has D/2 kappa^2 per area in plate theory. Hinges give, on the average over
// directions, 1.00 of it on equilateral triangles, 1.08 on irregular ones, 1.14 on a disc, 1.25 to 1.50 on
// halved squares (tested): no weight of single hinges is right on every mesh.
//
// Nodes: the edge x0 x1, then the corners opposite, x2 of the facet (x0, x1, x2) and x3 of (x1, x0, x3).
// Sources: Bergou et al. 2006, Garg et al. 2007 (polynomial hinges of flat and of curved sheets), Seung &
// Nelson 1988 (the factor); r is derived anew. Never throws.
#pragma once

#include "core/types.hpp"
#include "energy/kernels/cst.hpp"
#include "energy/term.hpp"
#include "energy/term_kind.hpp"

#include <Eigen/Dense>

#include <cmath>

namespace coapt {

struct BendingHinge {
  static constexpr int kNodes = 4;
  static constexpr std::string_view kType = "bending";
  static constexpr TermRole kRole = TermRole::Internal;
  static constexpr TermKind kKind = TermKind::Bending;

  using Vector12 = Eigen::Vector<double, 12>;
  using Matrix12 = Eigen::Matrix<double, 12, 12>;

  struct Rest {
    double stiffness = 0;        // k [force x length]
    Vec3 across = Vec3::Zero();  // cos(theta0/2) (m1 + m2) = sum across_i (x_i - x_0), i = 1..3 [1/length]
    double left = 0, right = 0;  // sin(theta0/2) over twice the area of each facet [1/length^2]
  };

  // stiffness: D. Pre: the facets are not degenerate at rest (the mesh check refuses those).
  static Rest rest(const Vec3& X0, const Vec3& X1, const Vec3& X2, const Vec3& X3, double stiffness) {
    const Vec3 e = X1 - X0, a = X2 - X0, b = X3 - X0;
    const double edge = e.norm(), left = e.cross(a).norm(), right = b.cross(e).norm();  // twice the areas
    const double half = 0.5 * angle(X0, X1, X2, X3), c = std::cos(half) * edge, s = std::sin(half);
    const double foot = a.dot(e) / left + b.dot(e) / right;
    return {2 * stiffness * edge * edge / (left + right),
            {-c * foot / (edge * edge), c / left, c / right},
            s / left,
            s / right};
  }

  // --- For parameters and other solvers ----------------------------------------------------------------
  static double hinge_stiffness(const Rest& hinge) { return hinge.stiffness; }
  static Rest reshaped(const Rest& hinge, const Corners& from, const Corners& X) {
    const Rest unit = rest(from[0], from[1], from[2], from[3], 1);
    return rest(X[0], X[1], X[2], X[3], hinge.stiffness / unit.stiffness);
  }
  static void stiffen(Rest& hinge, double factor, bool /*is_size*/) { hinge.stiffness *= factor; }

  // theta in [-pi, pi]; 0 where a facet has no area. The sine comes from the height of x3 over the first
  // facet: exact to the rounding of the coordinates in a nearly flat sheet, as a product of normals would not
  // be.
  static double angle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
    const Vec3 e = x1 - x0, b = x3 - x0, n1 = e.cross(x2 - x0), n2 = b.cross(e);
    return std::atan2(-e.norm() * n1.dot(b), n1.dot(n2));
  }

  static double evaluate(const Rest& rest, const Vector12& x, Vector12* g, Matrix12* H) {
    return evaluate(rest, x, g, H, true);
  }

  // Without the curvature of r: k J^T J, with J = dr/dx. Exact for a sheet that is flat at rest.
  static double evaluate_projected(const Rest& rest, const Vector12& x, Vector12* g, Matrix12* H) {
    return evaluate(rest, x, g, H, false);
  }

 private:
  static void add_cross_matrix(const Vec3& v, Eigen::Matrix3d& m) {
    m(0, 1) -= v[2];
    m(0, 2) += v[1];
    m(1, 0) += v[2];
    m(1, 2) -= v[0];
    m(2, 0) -= v[1];
    m(2, 1) += v[0];
  }

  static void set_pair(int row, int column, const Eigen::Matrix3d& block, Matrix12& H) {
    H.block<3, 3>(row, column) = block;
    H.block<3, 3>(column, row) = block.transpose();
  }

  static double evaluate(const Rest& rest, const Vector12& x, Vector12* g, Matrix12* H, bool is_exact) {
    const Vec3 x0 = x.segment<3>(0);
    const Vec3 e = x.segment<3>(3) - x0, a = x.segment<3>(6) - x0, b = x.segment<3>(9) - x0;
    const Vec3& c = rest.across;
    // The product of normals is e x (left a - right b).
    const Vec3 spread = rest.left * a - rest.right * b;
    const Vec3 r = c[0] * e + c[1] * a + c[2] * b + e.cross(spread);
    const double energy = 0.5 * rest.stiffness * r.squaredNorm();
    if (g == nullptr) return energy;

    // dr = (c_i + [u_i x]) dx_i for the corners i = 1, 2, 3; that of x0 is minus their sum.
    const Vec3 u[3] = {-spread, rest.left * e, -rest.right * e};
    const Vec3 kr = rest.stiffness * r;
    for (int i = 0; i < 3; ++i) g->segment<3>(3 * i + 3) = c[i] * kr + kr.cross(u[i]);
    g->head<3>() = -(g->segment<3>(3) + g->segment<3>(6) + g->segment<3>(9));
    if (H == nullptr) return energy;

    // k J_i^T J_j = k ((c_i c_j + u_i . u_j) I + [(c_i u_j - c_j u_i) x] - u_j u_i^T), and of r . d2r only
    // the products of e with a and b.
    const double k = rest.stiffness, kept = is_exact ? 1 : 0;
    const auto own = [&](int i) -> Eigen::Matrix3d {
      Eigen::Matrix3d m = (-k * u[i]) * u[i].transpose();
      m.diagonal().array() += k * (c[i] * c[i] + u[i].squaredNorm());
      return m;
    };
    const auto coupling = [&](int i, int j, const Vec3& curvature) -> Eigen::Matrix3d {
      Eigen::Matrix3d m = (-k * u[j]) * u[i].transpose();
      add_cross_matrix(k * (c[i] * u[j] - c[j] * u[i]) + curvature, m);
      m.diagonal().array() += k * (c[i] * c[j] + u[i].dot(u[j]));
      return m;
    };
    const Eigen::Matrix3d h11 = own(0), h22 = own(1), h33 = own(2);
    const Eigen::Matrix3d h21 = coupling(1, 0, (kept * rest.left) * kr),
                          h31 = coupling(2, 0, (-kept * rest.right) * kr), h32 = coupling(2, 1, Vec3::Zero());
    const Eigen::Matrix3d h10 = -(h11 + h21.transpose() + h31.transpose()),
                          h20 = -(h21 + h22 + h32.transpose()), h30 = -(h31 + h32 + h33);
    const Eigen::Matrix3d sum = h21 + h31 + h32;
    H->block<3, 3>(0, 0) = (h11 + h22 + h33) + (sum + sum.transpose());
    H->block<3, 3>(3, 3) = h11;
    H->block<3, 3>(6, 6) = h22;
    H->block<3, 3>(9, 9) = h33;
    set_pair(3, 0, h10, *H);
    set_pair(6, 0, h20, *H);
    set_pair(9, 0, h30, *H);
    set_pair(6, 3, h21, *H);
    set_pair(9, 3, h31, *H);
    set_pair(9, 6, h32, *H);
    return energy;
  }
};

}  // namespace coapt
