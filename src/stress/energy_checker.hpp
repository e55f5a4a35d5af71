// Whether the energy fell at every iterate. Private to this room.
#pragma once

#include "optim/solver.hpp"

#include <string>

namespace coapt {

// One sentence on the first accepted state whose energy is above that of the one before it, of the same
// round, by more than ten times what the solvers themselves take for rounding; empty: there is none. Searches
// for a state without forces climb where that makes forces smaller, and are left out. Of a shape that has
// grown a hundredfold the areas are known to the rounding of squared coordinates: nothing is judged. start:
// positions [mm]. Pre: the trace is of one potential from start to end.
std::string energy_rise(const Result& result, Objective& objective, const Points& start);

}  // namespace coapt
