// Are the derivatives right? Taylor remainders and central differences of a term or of a whole
// objective, at any state: also the user's own scene.
#pragma once

#include "energy/objective.hpp"

#include <string>

namespace coapt {

struct DerivativeOptions {
  double largest_step = 1e-1;   // of the ladder of steps h, in units of the directions
  double smallest_step = 1e-6;  // two steps per decade in between
};

// What passes.
inline constexpr double kLeastGradientSlope = 1.95, kLeastHessianSlope = 2.9;
inline constexpr double kMostGradientError = 1e-7, kMostHessianError = 1e-6;

// Worst figures over all directions. With E(q + h d) and the remainders
//   R1(h) = |E(q + h d) - E(q) - h g.d|,   R2(h) = |... - h^2/2 d.H d|
// each the larger of the two at +h and -h, right derivatives give R1 ~ h^2 and R2 ~ h^3: slopes of 2 and 3 on
// a log-log ladder of steps, read at its finest decade above round-off. A remainder that is nothing but
// round-off (a linear term has no R1, a quadratic one no R2) has slope +infinity.
//
// At a kink (a chord at its length) the Hessian jumps, by right. Where a direction does not pass, the Hessian
// is asked at the other steps too: if it is right on either side, R2(h) <= h^2/2 max |d.(H(q + s d) - H) d|
// over |s| <= h, and differences of g err by no more than H d changes. A direction is counted in `kinks`, and
// not in the slope, if both hold down to the finest steps and H d jumps in at most a twentieth of its
// components; a Hessian that is wrong errs by more than it changes at small steps, and fails.
struct DerivativeReport {
  std::string name, type;
  double energy = 0;         // at the state [force x length]
  double gradient_norm = 0;  // 2-norm [force]; 0: the term is not active here and nothing was tested
  double gradient_slope = kInfinity;
  double hessian_slope = kInfinity;
  double gradient_error = 0;  // central differences of E against g.d, relative, at the best step
  double hessian_error = 0;   // central differences of g against H d, relative, at the best step
  int kinks = 0;              // directions in which a jump of the Hessian explains all that is amiss

  bool is_active() const { return gradient_norm > 0; }
  bool has_passed() const {
    return gradient_slope >= kLeastGradientSlope && hessian_slope >= kLeastHessianSlope &&
           gradient_error <= kMostGradientError && hessian_error <= kMostHessianError;
  }
};

// The objective at q. directions: unknown_count x direction_count [length], not all zero, zero at
// prescribed coordinates. A circulatory force counts as dead, as it does in objective.value().
DerivativeReport check_derivatives(Objective& objective, const Vector& q, const Eigen::MatrixXd& directions,
                                   const DerivativeOptions& options = {});

// One term alone at positions x; its candidates and counters are updated meanwhile. directions:
// 3 node_count x direction_count [length].
DerivativeReport check_derivatives(EnergyTerm& term, const Points& x, const Eigen::MatrixXd& directions,
                                   const DerivativeOptions& options = {});

// Seeded random directions over all nodes, 3 node_count x count, zero at prescribed coordinates; the node
// that moves most moves by `step` [length]. Same seed, same directions on every platform.
Eigen::MatrixXd random_directions(const FixedMask& fixed, int count, double step, unsigned seed);

}  // namespace coapt
