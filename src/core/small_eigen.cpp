#include "core/small_eigen.hpp"

#include <Eigen/Eigenvalues>

namespace coapt {
namespace {

using Solver = Eigen::SelfAdjointEigenSolver<SmallMatrix>;

}  // namespace

SmallEigen small_eigen(const SmallMatrix& symmetric) {
  const Solver solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SmallVector small_eigenvalues(const SmallMatrix& symmetric) {
  return Solver(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace coapt
