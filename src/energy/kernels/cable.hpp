// Linear elastic cable that carries tension only, or a constant tension.
//   W = EA/r psi(l - r) + T l,   l = |x1 - x0|,   psi(e) = e^2/2 for e > s, 0 for e < 0
// EA axial stiffness [force], r rest length [length], T constant tension [force]: a pure
// constant-force cable has EA = 0. The kink of the force at e = 0 is rounded over 0 < e < s by
// psi' = 2 e^2/s - e^3/s^2, which makes psi twice continuously differentiable, keeps the slack cable
// force-free and the taut one (e > s) exact. s = 0: the sharp kink.
// Source: Hammer et al. 2011 (chords); the rounding is our own. Never throws.
#pragma once

#include "energy/kernels/axial.hpp"
#include "energy/term.hpp"
#include "energy/term_kind.hpp"

#include <algorithm>

namespace coapt {

struct Cable {
  static constexpr int kNodes = 2;
  static constexpr std::string_view kType = "cable";
  static constexpr TermRole kRole = TermRole::Internal;
  static constexpr TermKind kKind = TermKind::Line;

  struct Rest {
    double stiffness = 0;  // EA / r [force/length]
    double length = 0;     // r
    double smoothing = 0;  // s [length]
    double tension = 0;    // T [force]
  };

  // The same cable with its kink rounded over at least this share of its length.
  static Rest rounded(Rest rest, double share) {
    rest.smoothing = std::max(rest.smoothing, share * rest.length);
    return rest;
  }

  // The elastic part's energy, force and stiffness at elongation e.
  static AxialLaw elastic(const Rest& rest, double e) {
    if (e <= 0) return {};
    const double s = rest.smoothing, k = rest.stiffness;
    if (e >= s) return {k * (0.5 * e * e - s * s / 12), k * e, k};
    const double u = e / s;
    return {k * s * s * u * u * u * (2.0 / 3 - u / 4), k * s * u * u * (2 - u), k * u * (4 - 3 * u)};
  }

  // The whole of it at the distance l; coincident ends have no direction to pull in.
  static AxialLaw axial(const Rest& rest, double l) {
    AxialLaw law = elastic(rest, l - rest.length);
    if (l > 0) {
      law.energy += rest.tension * l;
      law.force += rest.tension;
    }
    return law;
  }

  // --- For parameters and other solvers ----------------------------------------------------------------
  static LineTraits line(const Rest& rest) {
    return {.length = rest.length,
            .onset = rest.smoothing,
            .begins_softly = rest.smoothing > 0,
            .is_one_law = rest.length == 0,
            .is_straight = !(rest.smoothing > 0 || rest.tension > 0),
            .stiffness = rest.stiffness};
  }
  static void lengthen(Rest& rest, double length) {
    rest.stiffness *= rest.length / length;
    rest.smoothing *= length / rest.length;
    rest.length = length;
  }
  static RestSlope slope_by_rest(const Rest& rest, const AxialLaw& law, double l) {
    return homogeneous_slope(law, l, rest.length);
  }
  static void stiffen(Rest& rest, double factor, bool /*is_size*/) { rest.stiffness *= factor; }
  static bool has_prestress(const Rest& rest) { return rest.tension != 0; }

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
