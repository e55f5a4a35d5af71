// Bending of a sheet, lumped in the hinge between two triangles.
//   W = k/2 (theta - theta0)^2,   k = D |e|^2 / (A1 + A2)
// theta the signed angle between the facets' normals (positive on a ridge), theta0 that at rest, |e| length
// of the common edge and A1, A2 areas of the facets at rest, D plate stiffness [force x length].
// A sheet rolled to a cylinder has D/2 kappa^2 per area in plate theory. Hinges give, on the average over
// directions, 1.00 of it on equilateral triangles, 1.08 on irregular ones, 1.14 on a disc, 1.25 to 1.50 on
// halved squares (tested): no weight of single hinges is right on every mesh.
// Linear in theta rather than in 2 tan(theta/2), which locks an edge long before two sheets meet in a sharp
// fold and lets one fold govern the stiffness. theta - theta0 is taken in [-pi, pi]: W is continuous
// everywhere, with a kink where the fold is half a turn from rest (the sheet passes through itself).
// Nodes: the edge x0 x1, then the corners opposite, x2 of the facet (x0, x1, x2) and x3 of (x1, x0, x3).
// A facet without height has no normal: the hinge then has no moment and keeps a finite energy.
// Sources: Grinspun et al. 2003 (hinges), Seung & Nelson 1988 (the factor), Tamstorf & Grinspun 2013 (that
// the Hessian has a closed form; the one below is derived anew). Never throws.
#pragma once

#include "core/types.hpp"
#include "energy/term.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {

struct BendingHinge {
  static constexpr int kNodes = 4;
  static constexpr std::string_view kType = "bending";
  static constexpr TermRole kRole = TermRole::Internal;

  using Vector12 = Eigen::Vector<double, 12>;
  using Matrix12 = Eigen::Matrix<double, 12, 12>;

  struct Rest {
    double stiffness = 0;  // k [force x length]
    double angle = 0;      // theta0
  };

  // stiffness: D. Pre: the facets are not degenerate at rest (the mesh check refuses those).
  static Rest rest(const Vec3& X0, const Vec3& X1, const Vec3& X2, const Vec3& X3, double stiffness) {
    const Vec3 e = X1 - X0;
    const double areas = 0.5 * (e.cross(X2 - X0).norm() + e.cross(X3 - X0).norm());
    return {stiffness * e.squaredNorm() / areas, angle(X0, X1, X2, X3)};
  }

  // theta in [-pi, pi]; 0 where a facet has no area.
  static double angle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
    const Vec3 e = x1 - x0, a = x2 - x0, b = x3 - x0;
    return angle(e.norm(), e.cross(a), b.cross(e), b);
  }

  static double evaluate(const Rest& rest, const Vector12& x, Vector12* g, Matrix12* H) {
    return evaluate(rest, x, g, H, true);
  }

  // Without the curvature of the angle itself: k grad(theta) grad(theta)^T.
  static double evaluate_projected(const Rest& rest, const Vector12& x, Vector12* g, Matrix12* H) {
    return evaluate(rest, x, g, H, false);
  }

 private:
  // n1, n2: normals of any length. The sine comes from the height of x3 over the first facet, b . n1: exact
  // to the rounding of the coordinates in a nearly flat sheet, where a cross product of normals would not be.
  static double angle(double edge, const Vec3& n1, const Vec3& n2, const Vec3& b) {
    return std::atan2(-edge * n1.dot(b), n1.dot(n2));
  }

  // One facet seen from the hinge, whose corners move the angle by c_a n / h.
  struct Facet {
    Vec3 normal, across;    // unit; across: in the facet, from the edge to the opposite corner
    double per_height = 0;  // 1/h
    double c[2];            // of x0 and x1; that of the opposite corner is -1
  };

  // Below this height, relative to the edges, the direction of the normal is round-off.
  static constexpr double kFlatness = 1e-12;

  static bool is_degenerate(double normal, double edge_squared, const Vec3& side) {
    return normal <= kFlatness * std::max(edge_squared, side.squaredNorm());
  }

  // length: of the normal. turn: 1 for the facet on the left of the edge, -1 on the right.
  static Facet facet(const Vec3& normal, double length, const Vec3& direction, double per_edge,
                     const Vec3& side, double turn) {
    Facet f;
    f.normal = normal * (1 / length);
    f.per_height = 1 / (length * per_edge);
    f.across = turn * f.normal.cross(direction);
    const double t = side.dot(direction) * per_edge;
    f.c[0] = 1 - t;
    f.c[1] = t;
    return f;
  }

  static double evaluate(const Rest& rest, const Vector12& x, Vector12* g, Matrix12* H, bool is_exact) {
    const Vec3 x0 = x.segment<3>(0);
    const Vec3 e = x.segment<3>(3) - x0, a = x.segment<3>(6) - x0, b = x.segment<3>(9) - x0;
    const Vec3 n1 = e.cross(a), n2 = b.cross(e);
    const double edge_squared = e.squaredNorm(), length1 = n1.norm(), length2 = n2.norm();
    if (is_degenerate(length1, edge_squared, a) || is_degenerate(length2, edge_squared, b)) {
      if (g != nullptr) g->setZero();
      if (H != nullptr) H->setZero();
      return 0.5 * rest.stiffness * rest.angle * rest.angle;
    }
    const double edge = std::sqrt(edge_squared);
    double fold = angle(edge, n1, n2, b) - rest.angle;
    if (std::abs(fold) > std::numbers::pi) fold -= std::copysign(2 * std::numbers::pi, fold);
    const double energy = 0.5 * rest.stiffness * fold * fold;
    if (g == nullptr) return energy;

    const double per_edge = 1 / edge;
    const Vec3 direction = e * per_edge;
    const Facet left = facet(n1, length1, direction, per_edge, a, 1),
                right = facet(n2, length2, direction, per_edge, b, -1);
    const Vec3 q1 = left.normal * left.per_height, q2 = right.normal * right.per_height;
    Vector12 slope;  // of theta
    slope.segment<3>(0) = left.c[0] * q1 + right.c[0] * q2;
    slope.segment<3>(3) = left.c[1] * q1 + right.c[1] * q2;
    slope.segment<3>(6) = -q1;
    slope.segment<3>(9) = -q2;
    const double moment = rest.stiffness * fold;
    *g = moment * slope;
    if (H == nullptr) return energy;
    H->noalias() = (rest.stiffness * slope) * slope.transpose();
    if (!is_exact) return energy;
    add_curvature(left, direction, per_edge, moment, 6, *H);
    add_curvature(right, direction, per_edge, moment, 9, *H);
    return energy;
  }

  // Adds `moment` times the share of one facet in the Hessian of theta. With n the normal, m across, d along
  // the edge, h the height, epsilon = (-1, 1, 0) and c as above, the derivative of c_a n/h by corner b is
  //   (c_a c_b/h^2) (m n^T + n m^T) - (c_a eps_b d n^T + eps_a c_b n d^T)/(h |e|) + eps_a eps_b n m^T/|e|^2.
  // The last is taken symmetrically: the skew parts of the two facets cancel.
  static void add_curvature(const Facet& f, const Vec3& direction, double per_edge, double moment,
                            int opposite, Matrix12& H) {
    const double per_height_squared = f.per_height * f.per_height, half = 0.5 * per_edge * per_edge;
    const Vec3 across = moment * f.across, along = (moment * f.per_height * per_edge) * direction;
    const Eigen::Matrix3d bend = across * f.normal.transpose() + f.normal * across.transpose();
    const Eigen::Matrix3d twist = along * f.normal.transpose(), turn = twist.transpose();
    const double c0 = f.c[0], c1 = f.c[1];
    const auto add = [&](int row, int column, const Eigen::Matrix3d& block) {
      H.block<3, 3>(row, column) += block;
      if (row != column) H.block<3, 3>(column, row) += block.transpose();
    };
    add(0, 0, (c0 * c0 * per_height_squared + half) * bend + c0 * (twist + turn));
    add(3, 3, (c1 * c1 * per_height_squared + half) * bend - c1 * (twist + turn));
    add(3, 0, (c0 * c1 * per_height_squared - half) * bend + c1 * twist - c0 * turn);
    add(opposite, opposite, per_height_squared * bend);
    add(opposite, 0, (-c0 * per_height_squared) * bend - twist);
    add(opposite, 3, (-c1 * per_height_squared) * bend + twist);
  }
};

}  // namespace coapt
