// The nearest positive semidefinite matrix of an element Hessian, so that a sum of them is one.
#pragma once

#include <Eigen/Dense>

namespace coapt {

// Sets the negative eigenvalues of a symmetric matrix to zero (Teran et al. 2005, section 6).
template <typename Matrix>
void project_psd(Matrix& h) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(h);
  if (eigen.eigenvalues()[0] >= 0) return;
  h = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace coapt
