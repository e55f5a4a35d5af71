// How uncertain figures are when the parameters are: to first order.
#pragma once

#include "core/types.hpp"

namespace coapt {

// J C J^T, jacobian: one row for each figure, one column for each number; covariance: symmetric, of the
// numbers. Throws InputError, all defects in one pass: sizes that do not fit, entries that are not finite, a
// covariance that is not symmetric (to 1e-12 of its largest entry) or has a negative eigenvalue (beyond
// 1e-10 of the largest).
Eigen::MatrixXd first_order_covariance(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& covariance);

}  // namespace coapt
