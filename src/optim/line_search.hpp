// Step length along a descent direction, shared by the gradient-based solvers.
#pragma once

#include "optim/monitor.hpp"

namespace coapt {

// A point on the line, with everything evaluated there.
struct LinePoint {
  double step = 0;
  double energy = 0;
  double slope = 0;  // directional derivative
  Vector q, g;
};

// Finds a step that satisfies the strong-curvature and sufficient-decrease (Wolfe) conditions; where the
// change of energy drowns in round-off, the sufficient decrease is judged by the slopes alone
// (approximate Wolfe condition of Hager & Zhang 2005). Infinite energies are backed away from.
//   from: the current point with its slope < 0 along `direction`; step 0.
//   first: the first step to try, > 0.
// Returns false when no acceptable step was found; `to` then holds the best finite point seen, whose
// energy is never above from's by more than round-off.
bool search_line(Monitor& monitor, const LinePoint& from, const Vector& direction, double first,
                 LinePoint& to);

}  // namespace coapt
