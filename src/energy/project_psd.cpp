#include "energy/project_psd.hpp"

#include <Eigen/Eigenvalues>

namespace coapt {

template <int kSize>
void project_psd(Eigen::Matrix<double, kSize, kSize>& h) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kSize, kSize>> eigen(h);
  if (eigen.eigenvalues()[0] >= 0) return;
  h = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
}

template void project_psd<6>(Eigen::Matrix<double, 6, 6>&);
template void project_psd<9>(Eigen::Matrix<double, 9, 9>&);
template void project_psd<12>(Eigen::Matrix<double, 12, 12>&);

}  // namespace coapt
