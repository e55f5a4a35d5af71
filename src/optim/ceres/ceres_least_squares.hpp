// Ceres' least squares within bounds, for functions of few variables.
#pragma once

#include "optim/bounded_minimiser.hpp"

namespace coapt {

// Adds "ceres": Levenberg-Marquardt with a dense QR factorisation; steps are projected on the bounds.
void add_ceres_minimiser(BoundedMinimiserTable& table);

}  // namespace coapt
