// Bending of a sheet, lumped in the hinge between two triangles.
//   W = k/2 (theta - theta0)^2,   k = D |e|^2 / (A1 + A2)
// theta the signed angle between the facets' normals (positive on a ridge), theta0 that at rest, |e| length
// of the common edge and A1, A2 areas of the facets at rest, D plate stiffness [force x length]. A sheet
// rolled to a cylinder so has, on the average over directions, the energy D/2 kappa^2 per area of plate
// theory; on regular meshes it has exactly that (docs/theory.md tells what was measured on irregular ones).
// The law is linear in theta rather than in 2 tan(theta/2), which would lock an edge long before two sheets
// meet in a sharp fold and make one facet's fold dominate the stiffness. theta - theta0 is taken in [-pi,
// pi]: W is continuous everywhere, with a kink where the fold is half a turn from rest (through the sheet
// itself). Nodes: the edge x0 x1, then the corners opposite, x2 in the facet (x0, x1, x2) and x3 in (x1, x0,
// x3). A facet without height has no normal: the hinge then has no moment and keeps a finite energy. Sources:
// Grinspun et al. 2003 (hinges), Seung & Nelson 1988 (the factor), Tamstorf & Grinspun 2013 (that the Hessian
// has a closed form; the one below is our own derivation). Never throws.
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
    Vec3 normal, across;  // unit; across: in the facet, from the edge to the opposite corner
    double height = 0;
    double c[3];  // x0, x1, opposite corner
  };

  // Below this height, relative to the edges, the direction of the normal is round-off.
  static constexpr double kFlatness = 1e-12;

  static bool is_degenerate(const Vec3& normal, const Vec3& e, const Vec3& side) {
    const double longest = std::max(e.squaredNorm(), side.squaredNorm());
    return normal.norm() <= kFlatness * longest;
  }

  // turn: 1 for the facet on the left of the edge, -1 on the right.
  static Facet facet(const Vec3& normal, const Vec3& direction, double edge, const Vec3& side, double turn) {
    Facet f;
    const double length = normal.norm();
    f.normal = normal / length;
    f.height = length / edge;
    f.across = turn * f.normal.cross(direction);
    const double t = side.dot(direction) / edge;
    f.c[0] = 1 - t;
    f.c[1] = t;
    f.c[2] = -1;
    return f;
  }

  static double evaluate(const Rest& rest, const Vector12& x, Vector12* g, Matrix12* H, bool is_exact) {
    const Vec3 x0 = x.segment<3>(0);
    const Vec3 e = x.segment<3>(3) - x0, a = x.segment<3>(6) - x0, b = x.segment<3>(9) - x0;
    const Vec3 n1 = e.cross(a), n2 = b.cross(e);
    if (is_degenerate(n1, e, a) || is_degenerate(n2, e, b)) {
      if (g != nullptr) g->setZero();
      if (H != nullptr) H->setZero();
      return 0.5 * rest.stiffness * rest.angle * rest.angle;
    }
    const double edge = e.norm();
    double fold = angle(edge, n1, n2, b) - rest.angle;
    if (std::abs(fold) > std::numbers::pi) fold -= std::copysign(2 * std::numbers::pi, fold);
    const double energy = 0.5 * rest.stiffness * fold * fold;
    if (g == nullptr) return energy;

    const Vec3 direction = e / edge;
    const Facet facets[2] = {facet(n1, direction, edge, a, 1), facet(n2, direction, edge, b, -1)};
    Vector12 slope;  // of theta
    const Vec3 q1 = facets[0].normal / facets[0].height, q2 = facets[1].normal / facets[1].height;
    slope.segment<3>(0) = facets[0].c[0] * q1 + facets[1].c[0] * q2;
    slope.segment<3>(3) = facets[0].c[1] * q1 + facets[1].c[1] * q2;
    slope.segment<3>(6) = -q1;
    slope.segment<3>(9) = -q2;
    const double moment = rest.stiffness * fold;
    *g = moment * slope;
    if (H == nullptr) return energy;
    H->noalias() = (rest.stiffness * slope) * slope.transpose();
    if (!is_exact) return energy;
    add_curvature(facets[0], direction, edge, moment, 6, *H);
    add_curvature(facets[1], direction, edge, moment, 9, *H);
    return energy;
  }

  // Adds `moment` times the share of one facet in the Hessian of theta. With n the normal, m across, d along
  // the edge, h the height, epsilon = (-1, 1, 0) and c as above, the derivative of c_a n/h by corner b is
  //   (c_a c_b/h^2) (m n^T + n m^T) - (c_a eps_b d n^T + eps_a c_b n d^T)/(h |e|) + eps_a eps_b n m^T/|e|^2.
  // The last is taken symmetrically: the skew parts of the two facets cancel.
  static void add_curvature(const Facet& f, const Vec3& direction, double edge, double moment, int opposite,
                            Matrix12& H) {
    const Eigen::Matrix3d mn = f.across * f.normal.transpose();
    const Eigen::Matrix3d bend = moment * (mn + mn.transpose());
    const Eigen::Matrix3d twist = (moment / (f.height * edge)) * (direction * f.normal.transpose());
    const double per_height = 1 / (f.height * f.height), per_edge = 0.5 / (edge * edge);
    const auto block = [&](int a, int b) { return H.block<3, 3>(a, b); };
    const double c0 = f.c[0], c1 = f.c[1];
    const Eigen::Matrix3d twist_sum = twist + twist.transpose();
    block(0, 0) += (c0 * c0 * per_height + per_edge) * bend + c0 * twist_sum;
    block(3, 3) += (c1 * c1 * per_height + per_edge) * bend - c1 * twist_sum;
    block(opposite, opposite) += per_height * bend;
    // a = x1, b = x0: eps_a = 1, eps_b = -1.
    const Eigen::Matrix3d edge_block =
        (c0 * c1 * per_height - per_edge) * bend + c1 * twist - c0 * twist.transpose();
    block(3, 0) += edge_block;
    block(0, 3) += edge_block.transpose();
    // a = opposite, c_a = -1, eps_a = 0.
    const Eigen::Matrix3d to_first = (-c0 * per_height) * bend - twist;
    const Eigen::Matrix3d to_second = (-c1 * per_height) * bend + twist;
    block(opposite, 0) += to_first;
    block(0, opposite) += to_first.transpose();
    block(opposite, 3) += to_second;
    block(3, opposite) += to_second.transpose();
  }
};

}  // namespace coapt
