// The constraints of position-based dynamics (Walczak et al. 2019, eq. 12-15): each is a value C(x) that is
// zero where it is met, its gradients, a compliance alpha (C^2/(2 alpha) is its energy) and a stiffness, the
// share of a correction that is applied at once (1: all of it).
//
// All values depend on relative positions and are invariant under rotation, so that the corrections w_a
// grad_a C d(lambda) keep linear and angular momentum to round-off. A constraint that is undefined at x (a
// collapsed triangle, coincident ends) has zero gradients there and corrects nothing.
#pragma once

#include "energy/kernels/axial.hpp"
#include "energy/kernels/bending.hpp"

#include <array>
#include <cmath>
#include <functional>

namespace coapt {

// Which multipliers are admissible: C > 0 is answered by lambda < 0, a pull.
enum class ConstraintSense { BothWays, PullsOnly, PushesOnly };

template <int N>
struct ConstraintValue {
  double value = 0;
  std::array<Vec3, N> gradient;
};

template <int N>
ConstraintValue<N> undefined_constraint() {
  ConstraintValue<N> v;
  v.gradient.fill(Vec3::Zero());
  return v;
}

// C = l - L.
struct StretchConstraint {
  static constexpr int kNodes = 2;
  std::array<int, 2> nodes{};
  double length = 0;  // L [length]
  double alpha = 0;   // [length/force]
  double stiffness = 1;
  ConstraintSense sense = ConstraintSense::BothWays;

  double compliance(double /*value*/) const { return alpha; }

  ConstraintValue<2> at(const Points& x) const {
    const Vec3 d = x.col(nodes[1]) - x.col(nodes[0]);
    const double l = d.norm();
    if (!(l > 0)) return undefined_constraint<2>();
    const Vec3 n = d / l;
    return {l - length, {-n, n}};
  }
};

// C = theta - theta0, the angle of a hinge; nodes and sign as in BendingHinge. Without sign C = |theta| -
// |theta0| (Walczak et al. 2019, eq. 13: the arc cosine), which does not tell the two ways to fold apart.
struct BendingConstraint {
  static constexpr int kNodes = 4;
  std::array<int, 4> nodes{};
  double angle = 0;  // theta0
  double alpha = 0;  // [1/(force x length)]
  double stiffness = 1;
  bool is_unsigned = false;
  static constexpr ConstraintSense sense = ConstraintSense::BothWays;

  double compliance(double /*value*/) const { return alpha; }

  // The corners opposite turn about the edge at rates 1/height; its ends take what is left by the lever.
  ConstraintValue<4> at(const Points& x) const {
    const Vec3 x0 = x.col(nodes[0]);
    const Vec3 e = x.col(nodes[1]) - x0, a = x.col(nodes[2]) - x0, b = x.col(nodes[3]) - x0;
    const Vec3 n1 = e.cross(a), n2 = b.cross(e);
    const double ee = e.squaredNorm(), nn1 = n1.squaredNorm(), nn2 = n2.squaredNorm();
    if (!(nn1 > 0 && nn2 > 0)) return undefined_constraint<4>();
    const double edge = std::sqrt(ee);
    const double theta = std::atan2(-edge * n1.dot(b), n1.dot(n2));
    if (is_unsigned && theta == 0 && angle != 0) return undefined_constraint<4>();
    const double sign = is_unsigned && theta < 0 ? -1 : 1;
    double change = is_unsigned ? std::abs(theta) - std::abs(angle) : theta - angle;
    if (change > M_PI) change -= 2 * M_PI;
    if (change < -M_PI) change += 2 * M_PI;
    const Vec3 g2 = -sign * edge / nn1 * n1, g3 = -sign * edge / nn2 * n2;
    const double s2 = a.dot(e) / ee, s3 = b.dot(e) / ee;
    return {change, {-(1 - s2) * g2 - (1 - s3) * g3, -s2 * g2 - s3 * g3, g2, g3}};
  }
};

// Area A of a triangle and its gradients.
inline ConstraintValue<3> triangle_area(const Points& x, const std::array<int, 3>& nodes) {
  const Vec3 x0 = x.col(nodes[0]), x1 = x.col(nodes[1]), x2 = x.col(nodes[2]);
  const Vec3 e1 = x1 - x0, e2 = x2 - x0, normal = e1.cross(e2);
  const double twice = normal.norm();
  if (!(twice > 0)) return undefined_constraint<3>();
  const Vec3 n = normal / (2 * twice);
  const Vec3 g1 = e2.cross(n), g2 = n.cross(e1);
  return {0.5 * twice, {-(g1 + g2), g1, g2}};
}

// C = A - A0.
struct AreaConstraint {
  static constexpr int kNodes = 3;
  std::array<int, 3> nodes{};
  double area = 0;   // A0 [length^2]
  double alpha = 0;  // [length^3/force]
  double stiffness = 1;
  ConstraintSense sense = ConstraintSense::BothWays;

  double compliance(double /*value*/) const { return alpha; }

  ConstraintValue<3> at(const Points& x) const {
    ConstraintValue<3> v = triangle_area(x, nodes);
    v.value -= area;
    return v;
  }
};

// C = |n|^2 - a0 with the cross product n of two edges, four times the squared area (Walczak et al. 2019,
// eq. 14).
struct SquaredAreaConstraint {
  static constexpr int kNodes = 3;
  std::array<int, 3> nodes{};
  double square = 0;  // a0 [length^4]
  double alpha = 0;   // [length^7/force]
  double stiffness = 1;
  static constexpr ConstraintSense sense = ConstraintSense::BothWays;

  double compliance(double /*value*/) const { return alpha; }

  ConstraintValue<3> at(const Points& x) const {
    const Vec3 x0 = x.col(nodes[0]), e1 = x.col(nodes[1]) - x0, e2 = x.col(nodes[2]) - x0;
    const Vec3 normal = e1.cross(e2), g1 = 2 * e2.cross(normal), g2 = 2 * normal.cross(e1);
    return {normal.squaredNorm() - square, {-(g1 + g2), g1, g2}};
  }
};

// C = A with the compliance A/sigma of the moment: its multiplier converges to the tension sigma, whatever
// the area.
struct FilmConstraint {
  static constexpr int kNodes = 3;
  std::array<int, 3> nodes{};
  double tension = 0;  // sigma [force/length]
  static constexpr double stiffness = 1;
  static constexpr ConstraintSense sense = ConstraintSense::PullsOnly;

  double compliance(double value) const { return value / tension; }
  ConstraintValue<3> at(const Points& x) const { return triangle_area(x, nodes); }
};

// A triangle of any energy W that is never negative: C = sqrt(2 W) with the compliance 1, so that where the
// sweeps converge the forces are those of W.
struct TriangleEnergyConstraint {
  static constexpr int kNodes = 3;
  std::array<int, 3> nodes{};
  std::function<double(const double* x, double* g)> energy;
  static constexpr double stiffness = 1;
  static constexpr ConstraintSense sense = ConstraintSense::BothWays;

  double compliance(double /*value*/) const { return 1; }

  ConstraintValue<3> at(const Points& x) const {
    Eigen::Vector<double, 9> corners, g;
    corners << x.col(nodes[0]), x.col(nodes[1]), x.col(nodes[2]);
    const double twice = 2 * energy(corners.data(), g.data());
    if (!(twice > 0)) return undefined_constraint<3>();
    const double value = std::sqrt(twice);
    g /= value;
    return {value, {g.segment<3>(0), g.segment<3>(3), g.segment<3>(6)}};
  }
};

// A line of any law F(l): C and compliance are those of the tangent to the law at the distance l of the
// moment, C = F/F', alpha = 1/F', so that where the sweeps converge the multiplier is the force of the law.
// Below its length a line that only pulls goes on with the last slope that it had: that lets go of what it
// held too much, and never pushes.
struct LineConstraint {
  static constexpr int kNodes = 2;
  std::array<int, 2> nodes{};
  double length = 0;  // at which it begins to pull [length]
  std::function<AxialLaw(double distance)> law;
  double slope = 0;  // the last [force/length]
  static constexpr double stiffness = 1;
  ConstraintSense sense = ConstraintSense::PullsOnly;
};

}  // namespace coapt
