// Directions in which a single node can be moved at no cost: junctions of slack chords, slack corners.
#pragma once

#include "core/types.hpp"
#include "linear/factorisation.hpp"

#include <functional>
#include <vector>

namespace coapt {

// Adds the product of v with a skew matrix to `product`; empty: there is none.
using SkewProduct = std::function<void(const Vector& v, Vector& product)>;

struct FreeDirections {
  int block = 0;         // of three unknowns: a node
  Eigen::MatrixXd axes;  // 3 x 1 ... 3, orthonormal
};

// The directions of each block in which a unit displacement changes no force in the scene by more than
// `least` [force/length], all forces taken together: they neither resist nor couple. Whatever the axes and
// the order of nodes, they are the same. lower: as Factorisation wants it, a unit row for each prescribed
// coordinate, which is no direction; with the skew matrix it is the tangent.
std::vector<FreeDirections> free_directions(const SparseMatrix& lower, const SkewProduct& skew,
                                            const std::vector<bool>& is_prescribed, double least);

}  // namespace coapt
