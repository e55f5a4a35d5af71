#include "sensitivity/determinacy.hpp"

#include <Eigen/QR>
#include <Eigen/SVD>

#include <cmath>

namespace coapt {
namespace {

constexpr double kNoShare = 1e-6;  // share in an undetermined direction that counts as none
constexpr double kOutlier = 6;     // standard deviations

}  // namespace

Determinacy determinacy(const Eigen::MatrixXd& jacobian, const Vector& noise) {
  const Eigen::Index count = jacobian.cols();
  // Of the square factor, the singular values and V are those of the whole.
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(count, count);
  if (jacobian.rows() > count) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(jacobian);
    square = qr.matrixQR().topRows(count).triangularView<Eigen::Upper>();
  } else {
    square.topRows(jacobian.rows()) = jacobian;
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(square, Eigen::ComputeFullV);
  Determinacy result{Vector::Zero(count), svd.matrixV(), svd.singularValues(), Vector::Zero(count)};

  const double least = kNoInfluence * result.singular_values[0];
  Eigen::MatrixXd spread = noise.asDiagonal() * (jacobian * result.directions);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double s = result.singular_values[k];
    if (s > least)
      spread.col(k) /= s * s;
    else
      spread.col(k).setZero();
    result.direction_deviation[k] = s > least ? spread.col(k).norm() : kInfinity;
  }
  for (Eigen::Index j = 0; j < count; ++j) {
    result.deviation[j] = (spread * result.directions.row(j).transpose()).norm();
    for (Eigen::Index k = 0; k < count; ++k)
      if (!(result.singular_values[k] > least) && std::abs(result.directions(j, k)) > kNoShare)
        result.deviation[j] = kInfinity;
  }
  return result;
}

bool is_explained_by_noise(const Vector& residuals, const Vector& noise, const Vector& patch_sums) {
  return residuals.norm() <= noise.norm() && (residuals.array().abs() <= kOutlier * noise.array()).all() &&
         (patch_sums.array().abs() <= kOutlier).all();
}

}  // namespace coapt
