// The eigenvalues with the lowest real parts of a tangent that is not symmetric: those of a follower load.
#pragma once

#include "linear/free_directions.hpp"
#include "linear/lowest_modes.hpp"

#include <Eigen/Core>

#include <memory>

namespace coapt {

struct LowestEigenvalues {
  bool is_complete = false;  // else nothing was found that can be relied on, and nothing is here
  Eigen::VectorXcd values;   // ascending real parts [unit of the matrix]
  Eigen::MatrixXcd vectors;  // a column each
  int krylov_vectors = 0;    // that they were found among
};

// Unknowns up to which all eigenvalues are found, by a dense method.
constexpr int kMostDense = 240;

// All of K + W, K symmetric and W skew. lower: K as Factorisation wants it. start: zero at unknowns that
// shall stay at rest.
LowestEigenvalues all_eigenvalues(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start);

// Those of K + W with real parts up to zero, or the lowest alone: of those that couple to the lowest modes V
// of K, which are complete. As K is not negative on what is orthogonal to V, an eigenvalue l with a real part
// below -zero is a pole of V^T (K + W - l)^-1 V, a matrix as small as V has columns, and a zero of the
// determinant of its inverse F(l). K + W is projected onto the block Krylov space of (K + W + shift)^-1 from
// V. It is complete when, twice in a row, further blocks move the lowest eigenvalue by zero at most, leave
// the number of those below -zero, and change F by a twentieth at most on the line Re l = -zero, wherever it
// is looked at: by Rouche's theorem a change of less than one leaves the number of zeros beyond the line.
// team: may share the work.
LowestEigenvalues lowest_eigenvalues(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start,
                                     const LowestModes& modes, double zero,
                                     const std::shared_ptr<ThreadTeam>& team);

}  // namespace coapt
