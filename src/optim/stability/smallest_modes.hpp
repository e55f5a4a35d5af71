// The softest modes of an equilibrium: lowest eigenvalues of its Hessian.
#pragma once

#include "linear/factorisation.hpp"

#include <optional>

namespace coapt {

struct Modes {
  Vector values;               // ascending [unit of the matrix]
  Eigen::MatrixXd vectors;     // a column each, of unit length
  double shift = 0;            // the matrix plus this much on the diagonal was factorised
  bool has_converged = false;  // else: those found so far
};

// False in a build without Spectra.
bool has_smallest_modes();

// The `count` lowest eigenvalues, at most one less than the matrix has rows, by the Lanczos method on the
// inverse of the shifted matrix. Of a positive semidefinite matrix they are those of smallest magnitude, of
// another one the most negative. Unit rows, which stand for prescribed coordinates, are left out.
// lower: as Factorisation wants it. tolerance: of the eigenvalues of the inverse, relative.
// Nothing in a build without Spectra, or when no shift up to the size of the matrix makes it definite.
std::optional<Modes> smallest_modes(const SparseMatrix& lower, int count, const FactorisationFactory& factory,
                                    double tolerance = 1e-10);

}  // namespace coapt
