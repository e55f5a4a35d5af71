// Residuals of least squares that depend on a shape, with exact derivatives.
#pragma once

#include "core/types.hpp"

#include <vector>

namespace coapt {

// x: 3 x node_count positions.
class ResidualSet {
 public:
  virtual ~ResidualSet() = default;

  virtual Vector values(const Points& x) const = 0;

  // Derivatives along motions of the nodes (3 x node_count each): one row for each residual, one column for
  // each motion.
  virtual Eigen::MatrixXd derivatives(const Points& x, const std::vector<Points>& motions) const = 0;

  // sum_k weights_k grad r_k, 3 x node_count.
  virtual Points pull_back(const Points& x, const Vector& weights) const = 0;
};

// Those of a fit to what was measured.
class MeasuredResiduals : public ResidualSet {
 public:
  // Factor of each residual on what was measured: a measurement off by e moves it by at most that times e.
  virtual Vector noise_factors() const = 0;

  // How many residuals see the same measurement, with the same noise: as good as one of them.
  virtual int repetitions() const { return 1; }

  // Sums of `numbers` (one for each residual) over patches of neighbouring residuals, each over the root of
  // how many there are in it: of independent numbers with deviation 1, numbers with deviation 1.
  virtual Vector patch_sums(const Vector& numbers) const = 0;
};

}  // namespace coapt
