#include "sensitivity/metrics/covariance.hpp"

#include "core/error.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>

namespace coapt {

Eigen::MatrixXd first_order_covariance(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& covariance) {
  std::vector<std::string> defects;
  const Eigen::Index n = jacobian.cols();
  if (covariance.rows() != n || covariance.cols() != n)
    defects.push_back("covariance: is " + std::to_string(covariance.rows()) + " x " +
                      std::to_string(covariance.cols()) + "; there are " + std::to_string(n) +
                      " numbers, so it must be square of that size");
  if (!covariance.allFinite()) defects.emplace_back("covariance: has an entry that is not finite");
  if (!jacobian.allFinite()) defects.emplace_back("derivatives: an entry is not finite");
  if (!defects.empty()) throw InputError(defects);
  if (n == 0) return Eigen::MatrixXd::Zero(jacobian.rows(), jacobian.rows());
  const double largest = covariance.cwiseAbs().maxCoeff();
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > 1e-12 * largest)
    throw InputError("covariance: is not symmetric");
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(covariance, Eigen::EigenvaluesOnly);
  if (modes.eigenvalues().minCoeff() < -1e-10 * std::max(0.0, modes.eigenvalues().maxCoeff()))
    throw InputError("covariance: has a negative eigenvalue, which no covariance has");
  return jacobian * covariance * jacobian.transpose();
}

}  // namespace coapt
