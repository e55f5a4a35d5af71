// The lowest modes of a symmetric matrix, found as exactly as its sign on all other directions needs.
#pragma once

#include "linear/factorisation.hpp"

namespace coapt {

struct LowestModes {
  bool is_complete = false;  // the matrix is positive semidefinite on all that is orthogonal to `vectors`
  double shift = 0;          // the matrix plus this much on the diagonal is positive definite
  Eigen::VectorXd values;    // Rayleigh quotients of the vectors, ascending [unit of the matrix]
  Eigen::MatrixXd vectors;   // orthonormal: the modes below `zero`, and up to two beyond
  int factorisations = 0;
  int krylov_vectors = 0;  // that they were found among
};

// By the Lanczos method with blocks of two on the inverse of the shifted matrix. How many modes to find is
// known from the inertia of the matrix less `zero`, a positive number; more than 200 are not looked for.
// lower: as Factorisation wants it, with an eigenvalue below -zero. shift: one with which the matrix is
// positive definite, a positive number. starts: two columns with which it begins, zero where it shall stay at
// rest. factor: has analysed the pattern; its factor is lost.
LowestModes lowest_modes(const SparseMatrix& lower, double zero, double shift, const Eigen::MatrixXd& starts,
                         Factorisation& factor);

}  // namespace coapt
