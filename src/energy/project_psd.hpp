// The nearest positive semidefinite matrix of an element Hessian, so that a sum of them is one.
#pragma once

#include <Eigen/Core>

namespace coapt {

// Sets the negative eigenvalues of a symmetric matrix to zero (Teran et al. 2005, section 6). Defined for
// the sizes of the element laws, 6 (two nodes), 9 (three) and 12 (four).
template <int kSize>
void project_psd(Eigen::Matrix<double, kSize, kSize>& h);

extern template void project_psd<6>(Eigen::Matrix<double, 6, 6>&);
extern template void project_psd<9>(Eigen::Matrix<double, 9, 9>&);
extern template void project_psd<12>(Eigen::Matrix<double, 12, 12>&);

}  // namespace coapt
