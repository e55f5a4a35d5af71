#include "energy/project_psd.hpp"

#include "core/small_eigen.hpp"

#include <Eigen/Eigenvalues>

namespace coapt {

template <int kSize>
void project_psd(Eigen::Matrix<double, kSize, kSize>& h) {
  Eigen::Vector<double, kSize> values;
  Eigen::Matrix<double, kSize, kSize> vectors;
  if constexpr (kSize <= kSmallEigenRows) {
    const SmallEigen eigen = small_eigen(h);
    values = eigen.values;
    vectors = eigen.vectors;
  } else {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kSize, kSize>> eigen(h);
    values = eigen.eigenvalues();
    vectors = eigen.eigenvectors();
  }
  if (values[0] >= 0) return;
  h = vectors * values.cwiseMax(0).asDiagonal() * vectors.transpose();
}

template void project_psd<6>(Eigen::Matrix<double, 6, 6>&);
template void project_psd<9>(Eigen::Matrix<double, 9, 9>&);
template void project_psd<12>(Eigen::Matrix<double, 12, 12>&);

}  // namespace coapt
