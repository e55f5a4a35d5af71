// Eigenvalues and eigenvectors of a symmetric matrix of a few rows. Eigen's solver takes a compiler seven
// seconds for each size; this one is compiled once for all of them and gives the same to the bit.
#pragma once

#include <Eigen/Core>

namespace coapt {

// Up to here the bits are those of Eigen's solver of one size. Beyond ten rows its sums are in an order that
// depends on where in memory they lie.
inline constexpr int kSmallEigenRows = 9;

using SmallMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kSmallEigenRows, kSmallEigenRows>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kSmallEigenRows, 1>;

struct SmallEigen {
  SmallVector values;   // ascending, of the unit of the matrix
  SmallMatrix vectors;  // of the length 1, one a column
};

// By Eigen::SelfAdjointEigenSolver: tridiagonal form and implicit QR (Golub and Van Loan 2013, section 8.3).
// The lower triangle is read. Pre: square, of 1 to kSmallEigenRows rows. Never throws; of entries that are
// not finite nothing follows.
SmallEigen small_eigen(const SmallMatrix& symmetric);

// The values alone.
SmallVector small_eigenvalues(const SmallMatrix& symmetric);

}  // namespace coapt
