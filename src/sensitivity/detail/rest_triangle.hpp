// Derivatives of a membrane triangle of any law by the places of its corners at rest. The first axis of its
// rest frame, along a fibre where the law has one, is a line that is drawn on the triangle: it goes with the
// corners.
#pragma once

#include "energy/term_access.hpp"

namespace coapt {

// Whether a triangle with its corners at X has that shape, but for round-off.
inline bool has_shape(const Eigen::Matrix2d& frame, const Corners& X) {
  constexpr double kSameShape = 1e-8;  // relative difference of the metrics that counts as none
  const Eigen::Matrix2d own = frame * frame.transpose(), inverse = cst_shape(X[0], X[1], X[2]).inverse,
                        wanted = inverse * inverse.transpose();
  return (wanted - own).norm() <= 2 * kSameShape * wanted.norm();
}

// For any W = A w(D_x D_X^-1), with the edges D_X in the rest frame, B = D_X^-1 and G = g . weights,
//   dG = tr(dD B) G - weights . H y - g . z,   D_y = F dD,  D_z = D_weights B dD.
// A motion whose gradient in the frame is L changes D_X by dD = P(L) D_X, P(L) = [[L11, L12 + L21], [0,
// L22]]: the frame turns with its first axis.
class RestTriangle {
 public:
  // Of an element whose corners are X at rest and x now. Pre: it has a rest frame.
  static RestTriangle at(const TermAccess& access, int element, const Corners& X, const double* x) {
    RestTriangle t;
    t.inverse_ = *access.rest_frame(element);
    t.edges_ = t.inverse_.inverse();
    t.axes_ = rest_edges(X) * t.inverse_;
    t.energy_ = access.evaluate_element(element, x, t.g_.data(), t.h_.data());
    t.F_ = edges_of(Eigen::Map<const CstVector>(x)) * t.inverse_;
    return t;
  }

  // Derivative of g . weights by the corners.
  CstVector pulled_back(const CstVector& weights) const {
    const double G = g_.dot(weights);
    const CstVector c = h_ * weights;
    const Eigen::Matrix<double, 3, 2> spread = edges_of(weights) * inverse_;
    Eigen::Matrix2d by_edges;
    for (int k = 0; k < 2; ++k)
      by_edges.col(k) = G * inverse_.row(k).transpose() - F_.transpose() * c.segment<3>(3 * k + 3) -
                        spread.transpose() * g_.segment<3>(3 * k + 3);
    return at_corners(by_edges);
  }

  // Change of g with a motion of the corners.
  CstVector pushed_forward(const CstVector& motion) const {
    const Eigen::Matrix2d L = axes_.transpose() * edges_of(motion) * inverse_;
    Eigen::Matrix2d turned;  // P(L)
    turned << L(0, 0), L(0, 1) + L(1, 0), 0, L(1, 1);
    const Eigen::Matrix2d change = turned * edges_, back = inverse_ * change;
    const Eigen::Matrix<double, 3, 2> y = F_ * change;
    CstVector moved;
    moved << Vec3::Zero(), y.col(0), y.col(1);
    CstVector result = back.trace() * g_ - h_ * moved;
    for (int j = 0; j < 2; ++j) {
      const Vec3 z = back(j, 0) * g_.segment<3>(3) + back(j, 1) * g_.segment<3>(6);
      result.segment<3>(3 * j + 3) -= z;
      result.head<3>() += z;
    }
    return result;
  }

  // Derivative of the energy by the corners.
  CstVector energy_slope() const {
    Eigen::Matrix2d by_edges;
    for (int k = 0; k < 2; ++k)
      by_edges.col(k) = energy_ * inverse_.row(k).transpose() - F_.transpose() * g_.segment<3>(3 * k + 3);
    return at_corners(by_edges);
  }

 private:
  static Eigen::Matrix<double, 3, 2> edges_of(const CstVector& v) {
    Eigen::Matrix<double, 3, 2> edges;
    edges << v.segment<3>(3) - v.head<3>(), v.segment<3>(6) - v.head<3>();
    return edges;
  }

  // From derivatives by the columns of D_X to those by the corners: the transpose of P.
  CstVector at_corners(const Eigen::Matrix2d& by_edges) const {
    Eigen::Matrix2d by_gradient = by_edges * edges_.transpose();
    by_gradient(1, 0) = by_gradient(0, 1);
    const Eigen::Matrix<double, 3, 2> m = axes_ * by_gradient * inverse_.transpose();
    CstVector result;
    result << -m.col(0) - m.col(1), m.col(0), m.col(1);
    return result;
  }

  Eigen::Matrix<double, 3, 2> axes_;  // of the rest frame
  Eigen::Matrix2d inverse_, edges_;   // B and D_X
  double energy_ = 0;
  CstVector g_;
  CstMatrix h_;
  Eigen::Matrix<double, 3, 2> F_;
};

}  // namespace coapt
