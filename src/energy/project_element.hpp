// The same projection as project_psd.hpp, and the same result to rounding, at a small part of its cost: an
// eigenvalue decomposition is the last resort, for the states in which nothing cheaper tells the answer.
#pragma once

#include <Eigen/Core>

namespace coapt {

// Sets the negative eigenvalues of the Hessian h of an element at x (node after node) to zero. Taken from h
// itself, whatever its energy: whether it is unchanged by translations, which leaves three unknowns less, and
// whether the direction of two nodes, or the normal of three, is a direction of its own, which parts what is
// left in two. A Hessian that is positive semidefinite is not touched. Defined for 2, 3 and 4 nodes. Never
// throws; where an entry is not finite the result is not either.
template <int kNodes>
void project_element(const Eigen::Vector<double, 3 * kNodes>& x,
                     Eigen::Matrix<double, 3 * kNodes, 3 * kNodes>& h);

// The same where it is known that translations change nothing, which is then not looked at.
template <int kNodes>
void project_invariant_element(const Eigen::Vector<double, 3 * kNodes>& x,
                               Eigen::Matrix<double, 3 * kNodes, 3 * kNodes>& h);

extern template void project_element<2>(const Eigen::Vector<double, 6>&, Eigen::Matrix<double, 6, 6>&);
extern template void project_element<3>(const Eigen::Vector<double, 9>&, Eigen::Matrix<double, 9, 9>&);
extern template void project_element<4>(const Eigen::Vector<double, 12>&, Eigen::Matrix<double, 12, 12>&);

extern template void project_invariant_element<2>(const Eigen::Vector<double, 6>&,
                                                  Eigen::Matrix<double, 6, 6>&);
extern template void project_invariant_element<3>(const Eigen::Vector<double, 9>&,
                                                  Eigen::Matrix<double, 9, 9>&);
extern template void project_invariant_element<4>(const Eigen::Vector<double, 12>&,
                                                  Eigen::Matrix<double, 12, 12>&);

}  // namespace coapt
