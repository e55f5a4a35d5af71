// Step length along a descent direction, shared by the gradient-based solvers.
#pragma once

#include "optim/monitor.hpp"

#include <functional>

namespace coapt {

// A point on the line, with everything evaluated there.
struct LinePoint {
  double step = 0;
  double energy = 0;
  double slope = 0;         // directional derivative
  bool is_limited = false;  // the terms let it go no farther
  Vector q, g;

  // The decrease of the energy from here that a quadratic promises, of which the whole step is the minimiser.
  double promised(double taken) const { return -slope * taken * (1 - 0.5 * taken); }
};

constexpr double kFewKept = 0.3;  // share of a promised decrease below which a step has failed its promise

// Puts another point in the place of `to`, or leaves it as it is and returns false.
using Replacement = std::function<bool(LinePoint& to)>;

// Finds a step that satisfies the strong-curvature and sufficient-decrease (Wolfe) conditions; where the
// change of energy drowns in round-off, the sufficient decrease is measured by the slopes alone
// (approximate Wolfe condition of Hager & Zhang 2005). Infinite energies are backed away from.
//   from: the current point with its slope < 0 along `direction`; step 0.
//   first: the first step to try, > 0.
//   replace: asked for another point where the first step, as far as it may go, keeps less than kFewKept of
//   the decrease that a quadratic promises; true: it has put one into `to`, which is taken. Null: none.
// Returns false when no acceptable step was found; `to` then holds the best finite point seen, whose
// energy is never above from's by more than round-off.
bool search_line(Monitor& monitor, const LinePoint& from, const Vector& direction, double first,
                 LinePoint& to, const Replacement& replace = {});

}  // namespace coapt
