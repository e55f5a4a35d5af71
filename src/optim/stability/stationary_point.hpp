// A state in which all forces vanish, be it a minimum of the energy or not.
#pragma once

#include "optim/monitor.hpp"

namespace coapt {

struct StationarySearch {
  bool is_found = false;
  double least_residual = kInfinity;  // relative, at any iterate
};

// Newton's method for the forces themselves, from q, which a line search makes smaller with every step: a
// minimiser leaves a saddle, this one comes to it. At most 20 iterations, accepted by the monitor in a round
// of its own. q: the state with the least forces afterwards. Wants the forces of a potential: with loads that
// have none nothing is found.
StationarySearch reach_stationary_point(Objective& objective, Vector& q, Monitor& monitor, double tolerance);

}  // namespace coapt
