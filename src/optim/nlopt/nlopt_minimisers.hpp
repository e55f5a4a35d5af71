// NLopt's minimisers within bounds, for functions of few variables.
#pragma once

#include "optim/bounded_minimiser.hpp"

namespace coapt {

// Adds "slsqp" (sequential quadratic programming, Kraft 1994), "mma" (method of moving asymptotes, Svanberg
// 2002), "lbfgs" (Liu & Nocedal 1989, with bounds) and "cobyla" (linear models without derivatives, Powell
// 1994: as many evaluations as variables before its first step).
void add_nlopt_minimisers(BoundedMinimiserTable& table);

}  // namespace coapt
