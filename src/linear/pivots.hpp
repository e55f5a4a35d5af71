// L D L^T without pivoting on a permuted matrix, for the signs of its pivots.
#pragma once

#include "linear/permuted_matrix.hpp"

namespace coapt {

// Pre: `upper` holds the upper triangle. Simplicial: as slow as Eigen's at any size.
Inertia inertia_of(const PermutedMatrix& upper);

}  // namespace coapt
