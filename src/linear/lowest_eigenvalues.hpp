// The eigenvalues with the lowest real parts of a tangent that is not symmetric: those of a follower load.
#pragma once

#include "linear/free_directions.hpp"

#include <Eigen/Core>

namespace coapt {

struct LowestEigenvalues {
  bool is_complete = false;  // no eigenvalue with a negative real part is missing
  Eigen::VectorXcd values;   // ascending real parts [unit of the matrix]
  Eigen::MatrixXcd vectors;  // a column each
  int factorisations = 0;
};

// Of K + W, K symmetric and W skew.
//   Small matrices: all eigenvalues, by a dense method.
//   Others: shift and invert (Arnoldi's method) around a negative shift. An eigenvalue whose real part is
//   negative lies in the disc around -shift through the ends of the segment between -i b and i b of the
//   imaginary axis, b bounding the imaginary parts of such values: the search is complete when what it found
//   reaches beyond.
// lower: K as Factorisation wants it. start: zero at unknowns that shall stay at rest. least_value: an
// estimate of K's lowest eigenvalue, negative. unstable: a real part below it ends the search, as the verdict
// is known. factor: has analysed the pattern of K; its factor is lost. In a build without Spectra large
// matrices give nothing.
LowestEigenvalues lowest_eigenvalues(const SparseMatrix& lower, const SkewProduct& skew, const Vector& start,
                                     double least_value, double unstable, Factorisation& factor);

}  // namespace coapt
