// Cubic tether: nothing up to its length, then a force that grows with the square of the excess.
//   W = t ((l - r)/rho)^3 for l > r, else 0,   l = |x1 - x0|
// t strength [force x length], r length [length], rho scale of the excess [length].
// Twice continuously differentiable at l = r, where its stiffness is zero: a barely taut tether adds
// nothing to the Hessian. Source: Burlina et al. 2010, eq. 15. Never throws.
#pragma once

#include "energy/kernels/axial.hpp"
#include "energy/term.hpp"

namespace coapt {

struct TetherCubic {
  static constexpr int kNodes = 2;
  static constexpr std::string_view kType = "tether_cubic";
  static constexpr TermRole kRole = TermRole::Internal;

  struct Rest {
    double strength = 0;  // t
    double length = 0;    // r
    double scale = 1;     // rho
  };

  static double evaluate(const Rest& rest, const Eigen::Vector<double, 6>& x, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* H) {
    const Vec3 difference = x.tail<3>() - x.head<3>();
    const double l = difference.norm();
    AxialLaw law;
    if (l > rest.length) {
      const double u = (l - rest.length) / rest.scale;
      law = {rest.strength * u * u * u, 3 * rest.strength * u * u / rest.scale,
             6 * rest.strength * u / (rest.scale * rest.scale)};
    }
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
