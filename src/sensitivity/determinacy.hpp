// Which numbers of a least-squares fit the data determine, and how well: to first order.
#pragma once

#include "core/types.hpp"

namespace coapt {

struct Determinacy {
  Vector deviation;  // standard deviation of each number; infinite where the data say nothing of it

  // The spectrum, best determined first: unit directions in the numbers as columns, the singular values of
  // the Jacobian and the standard deviation along each, infinite below kNoInfluence of the greatest value.
  Eigen::MatrixXd directions;
  Vector singular_values, direction_deviation;
};

inline constexpr double kNoInfluence = 1e-8;  // singular value, over the greatest, that determines nothing

// jacobian: of the residuals by the numbers, which are of like size (one row for each residual, as many
// columns as numbers, at least one); noise: standard deviation of each residual. The estimate is the
// least-squares one, every residual counted alike whatever its noise; noise is independent from residual to
// residual. With J = U S V^T and N = diag(noise^2) the covariance is V S^-2 V^T J^T N J V S^-2 V^T, and of a
// number with a share beyond 1e-6 of a direction without influence it is infinite. Pre: finite input.
Determinacy determinacy(const Eigen::MatrixXd& jacobian, const Vector& noise);

// Whether residuals that a fit leaves can be noise of this standard deviation each, independent and normal:
// they are together no greater, and nowhere stands out one of them, or a patch (MeasuredResiduals::patch_sums
// of the residuals over the noise), by six deviations. What a fit that is trapped leaves is in few places,
// and alike in neighbours.
bool is_explained_by_noise(const Vector& residuals, const Vector& noise, const Vector& patch_sums);

}  // namespace coapt
