// A link: a spring between two nodes that wants to be of its length, whatever the reference shape.
//   W = k/2 (l - L)^2,   l = |x1 - x0|
// k stiffness [force/length], L length [length], zero for a suture or a clip that brings two points together:
// then W = k/2 |x1 - x0|^2 is quadratic, with the constant Hessian k on each axis.
// Twice continuously differentiable but for coincident ends of a link with a length: there its force has no
// direction and none is given. Never throws. Source: the zero-length constraints of clips in Walczak et al.
// 2019, section 3.8, as an energy.
#pragma once

#include "energy/kernels/axial.hpp"
#include "energy/term.hpp"
#include "energy/term_kind.hpp"

#include <algorithm>

namespace coapt {

struct Link {
  static constexpr int kNodes = 2;
  static constexpr std::string_view kType = "link";
  static constexpr TermRole kRole = TermRole::Internal;
  static constexpr TermKind kKind = TermKind::Link;

  struct Rest {
    double stiffness = 0;  // k
    double length = 0;     // L
  };

  // For solvers that want more than forces: it pulls when longer than its length and pushes when shorter.
  static LineTraits line(const Rest& rest) {
    return {.length = rest.length,
            .is_one_law = true,
            .resists = true,
            .is_straight = true,
            .stiffness = rest.stiffness};
  }
  static AxialLaw axial(const Rest& rest, double l) {
    const double excess = l - rest.length;
    return {0.5 * rest.stiffness * excess * excess, rest.stiffness * excess, rest.stiffness};
  }

  static double evaluate(const Rest& rest, const Eigen::Vector<double, 6>& x, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* H) {
    return evaluate_with(rest, x, g, H, -kInfinity);
  }

  // The eigenvalues are twice the stiffness along the link and twice its force over its length across: the
  // latter, negative in a link that is pushed together, is set to zero.
  static double evaluate_projected(const Rest& rest, const Eigen::Vector<double, 6>& x,
                                   Eigen::Vector<double, 6>* g, Eigen::Matrix<double, 6, 6>* H) {
    return evaluate_with(rest, x, g, H, 0);
  }

 private:
  // least_across: of the stiffness across the link.
  static double evaluate_with(const Rest& rest, const Eigen::Vector<double, 6>& x,
                              Eigen::Vector<double, 6>* g, Eigen::Matrix<double, 6, 6>* H,
                              double least_across) {
    constexpr double kCoincident = 1e-12;  // of the length: ends nearer than this have no direction
    const Vec3 difference = x.tail<3>() - x.head<3>();
    const double l = difference.norm(), k = rest.stiffness, excess = l - rest.length;
    if (g == nullptr) return 0.5 * k * excess * excess;
    const bool has_direction = l > kCoincident * rest.length;
    // Force over length: k for a link without length, wherever its ends are.
    const double across = rest.length == 0 ? k : has_direction ? k * excess / l : 0;
    g->head<3>() = -across * difference;
    g->tail<3>() = across * difference;
    if (H != nullptr) {
      Eigen::Matrix3d block = std::max(across, least_across) * Eigen::Matrix3d::Identity();
      if (rest.length > 0 && has_direction) {
        const Vec3 n = difference / l;
        block += (k - std::max(across, least_across)) * n * n.transpose();
      }
      H->block<3, 3>(0, 0) = block;
      H->block<3, 3>(3, 3) = block;
      H->block<3, 3>(0, 3) = -block;
      H->block<3, 3>(3, 0) = -block;
    }
    return 0.5 * k * excess * excess;
  }
};

}  // namespace coapt
