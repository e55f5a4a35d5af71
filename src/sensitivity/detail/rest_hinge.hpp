// Derivatives of a bending hinge by the places of its corners at rest.
#pragma once

#include "energy/kernels/bending.hpp"
#include "energy/term_access.hpp"

#include <cmath>

namespace coapt {

// W = k/2 |r|^2, r = c1 e + c2 a + c3 b + e x (L a - R b) with the edges e, a, b from the first corner now
// (BendingHinge): k, c1, c2, c3, L and R alone know the shape at rest.
class RestHinge {
 public:
  using Vector12 = BendingHinge::Vector12;

  // Of an element whose corners are X at rest and x now. Pre: it is a hinge.
  static RestHinge at(const TermAccess& access, int element, const Corners& X, const double* x) {
    RestHinge h;
    const double unit = BendingHinge::rest(X[0], X[1], X[2], X[3], 1).stiffness;
    h.rest_ = BendingHinge::rest(X[0], X[1], X[2], X[3], access.hinge_stiffness(element) / unit);
    h.differentiate(X);
    h.now_ = edges_of(Eigen::Map<const Vector12>(x));
    h.r_ = residual(h.now_, h.rest_);
    return h;
  }

  // Derivative of g . weights by the corners.
  Vector12 pulled_back(const Vector12& weights) const {
    const Eigen::Matrix3d w = edges_of(weights);
    const Vec3 e = now_.col(0), a = now_.col(1), b = now_.col(2);
    const double k = rest_.stiffness;
    const Vec3 s = w * rest_.across + w.col(0).cross(rest_.left * a - rest_.right * b) +
                   e.cross(rest_.left * w.col(1) - rest_.right * w.col(2));  // dr/dx weights
    Numbers by;
    by << r_.dot(s), k * (now_.transpose() * s + w.transpose() * r_),
        k * (e.cross(a).dot(s) + r_.dot(w.col(0).cross(a) + e.cross(w.col(1)))),
        -k * (e.cross(b).dot(s) + r_.dot(w.col(0).cross(b) + e.cross(w.col(2))));
    return at_corners(by);
  }

  // Change of g with a motion of the corners.
  Vector12 pushed_forward(const Vector12& motion) const {
    const Eigen::Matrix3d m = edges_of(motion);
    const Numbers change = slopes_.transpose() * m.reshaped();
    const BendingHinge::Rest d{change[0], change.segment<3>(1), change[4], change[5]};
    const Vec3 e = now_.col(0), a = now_.col(1), b = now_.col(2);
    const Vec3 force = rest_.stiffness * r_,
               change_of_force = d.stiffness * r_ + rest_.stiffness * residual(now_, d);
    const Vec3 u[3] = {rest_.right * b - rest_.left * a, rest_.left * e, -rest_.right * e},
               change_of_u[3] = {d.right * b - d.left * a, d.left * e, -d.right * e};
    Eigen::Matrix3d result;
    for (int i = 0; i < 3; ++i)
      result.col(i) = d.across[i] * force + rest_.across[i] * change_of_force + change_of_force.cross(u[i]) +
                      force.cross(change_of_u[i]);
    return corners_of(result);
  }

  // Derivative of the energy by the corners.
  Vector12 energy_slope() const {
    const Vec3 e = now_.col(0), force = rest_.stiffness * r_;
    Numbers by;
    by << 0.5 * r_.squaredNorm(), now_.transpose() * force, e.cross(now_.col(1)).dot(force),
        -e.cross(now_.col(2)).dot(force);
    return at_corners(by);
  }

 private:
  using Numbers = Eigen::Vector<double, 6>;  // of k, c1, c2, c3, L, R
  using Edges = Eigen::Vector<double, 9>;

  static Eigen::Matrix3d edges_of(const Vector12& v) {
    Eigen::Matrix3d edges;
    edges << v.segment<3>(3) - v.head<3>(), v.segment<3>(6) - v.head<3>(), v.segment<3>(9) - v.head<3>();
    return edges;
  }

  static Vector12 corners_of(const Eigen::Matrix3d& by_edges) {
    Vector12 result;
    result << -by_edges.rowwise().sum(), by_edges.reshaped();
    return result;
  }

  static Vec3 residual(const Eigen::Matrix3d& edges, const BendingHinge::Rest& rest) {
    return edges * rest.across + edges.col(0).cross(rest.left * edges.col(1) - rest.right * edges.col(2));
  }

  Vector12 at_corners(const Numbers& by) const { return corners_of((slopes_ * by).reshaped(3, 3)); }

  // theta grows by 1/height where an opposite corner goes down by one; the ends of the edge move as much as
  // the corners' feet lie at them.
  void differentiate(const Corners& X) {
    const Vec3 e = X[1] - X[0], a = X[2] - X[0], b = X[3] - X[0];
    const double l = e.norm(), A = e.cross(a).norm(), B = b.cross(e).norm(), p = a.dot(e), q = b.dot(e);
    const Vec3 n1 = e.cross(a) / A, n2 = b.cross(e) / B, none = Vec3::Zero();
    Edges dl, dA, dB, dp, dq, dtheta;
    dl << e / l, none, none;
    dA << a.cross(n1), n1.cross(e), none;
    dB << n2.cross(b), none, e.cross(n2);
    dp << a, e, none;
    dq << b, none, e;
    dtheta << (p / A * n1 + q / B * n2) / l, -l / A * n1, -l / B * n2;
    const double half = 0.5 * BendingHinge::angle(X[0], X[1], X[2], X[3]), c = std::cos(half) * l,
                 s = std::sin(half), foot = p / A + q / B;
    const Edges dc = -0.5 * s * l * dtheta + c / l * dl, ds = 0.5 * c / l * dtheta,
                dfoot = (dp - p / A * dA) / A + (dq - q / B * dB) / B;
    slopes_ << rest_.stiffness * (2 / l * dl - (dA + dB) / (A + B)),
        (-foot * dc - c * dfoot + 2 * c * foot / l * dl) / (l * l), (dc - c / A * dA) / A,
        (dc - c / B * dB) / B, (ds - s / A * dA) / A, (ds - s / B * dB) / B;
  }

  BendingHinge::Rest rest_;
  Eigen::Matrix<double, 9, 6> slopes_;  // of each number, by the edges at rest
  Eigen::Matrix3d now_;                 // edges
  Vec3 r_;
};

}  // namespace coapt
