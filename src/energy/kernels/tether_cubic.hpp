// Cubic tether: nothing up to its length, then a force that grows with the square of the excess.
//   W = t ((l - r)/rho)^3 for l > r, else 0,   l = |x1 - x0|
// t strength [force x length], r length [length], rho scale of the excess [length].
// Twice continuously differentiable at l = r, where its stiffness is zero: a barely taut tether adds
// nothing to the Hessian. Source: Burlina et al. 2010, eq. 15. Never throws.
#pragma once

#include "energy/kernels/axial.hpp"
#include "energy/term.hpp"
#include "energy/term_kind.hpp"

#include <algorithm>

namespace coapt {

struct TetherCubic {
  static constexpr int kNodes = 2;
  static constexpr std::string_view kType = "tether_cubic";
  static constexpr TermRole kRole = TermRole::Internal;
  static constexpr TermKind kKind = TermKind::Line;

  struct Rest {
    double strength = 0;  // t
    double length = 0;    // r
    double scale = 1;     // rho
  };

  static AxialLaw axial(const Rest& rest, double l) {
    const double u = std::max(l - rest.length, 0.0) / rest.scale;
    return {rest.strength * u * u * u, 3 * rest.strength * u * u / rest.scale,
            6 * rest.strength * u / (rest.scale * rest.scale)};
  }

  // --- For parameters and other solvers ----------------------------------------------------------------
  static LineTraits line(const Rest& rest) { return {.length = rest.length, .begins_softly = true}; }
  static void lengthen(Rest& rest, double length) { rest.length = length; }
  // A function of l - r alone.
  static RestSlope slope_by_rest(const Rest&, const AxialLaw& law, double /*l*/) {
    return {-law.force, -law.stiffness};
  }
  static void stiffen(Rest& rest, double factor, bool /*is_size*/) { rest.strength *= factor; }

  static double evaluate(const Rest& rest, const Eigen::Vector<double, 6>& x, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* H) {
    const Vec3 difference = x.tail<3>() - x.head<3>();
    const double l = difference.norm();
    const AxialLaw law = axial(rest, l);
    expand_axial(law, difference, l, g, H);
    return law.energy;
  }

  // Force and stiffness are never negative, so neither is the exact Hessian.
  static double evaluate_projected(const Rest& rest, const Eigen::Vector<double, 6>& x,
                                   Eigen::Vector<double, 6>* g, Eigen::Matrix<double, 6, 6>* H) {
    return evaluate(rest, x, g, H);
  }
};

}  // namespace coapt
