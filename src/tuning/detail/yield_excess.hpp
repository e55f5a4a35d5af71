// By how much chords and orifice exceed what is wanted of them. Private to this room.
#pragma once

#include "sensitivity/metrics/residual_set.hpp"
#include "tuning/region_tuning.hpp"

namespace coapt {

// One residual for each line with a rest length, and one for the orifice where it has a limit: how far strain
// or area are above their limits less a margin, relative to these; 0 below. Derivatives are exact with the
// view on the orifice held, as it is where the annulus is prescribed.
class YieldExcess final : public ResidualSet {
 public:
  // model: its lines, mesh and annulus; must outlive this object, and rest lengths may not change.
  YieldExcess(const Model& model, double yield_strain, std::optional<double> orifice_limit_mm2);

  Vector values(const Points& x) const override;
  Eigen::MatrixXd derivatives(const Points& x, const std::vector<Points>& motions) const override;
  Points pull_back(const Points& x, const Vector& weights) const override;

  // A sum of squares below which nothing is beyond its limit.
  static double enough();

 private:
  struct Excess {
    Vector values;      // of all residuals
    Points of_line;     // derivative of each line's value by the place of its first end
    Points of_orifice;  // of the last value, by all nodes
  };
  Excess excess(const Points& x, bool wants_derivatives) const;

  const Model& model_;
  double yield_strain_;
  std::optional<double> limit_;
  std::vector<size_t> lines_;  // of the model, that have a rest length
};

// The figures themselves, with the strain beyond which a chord counts as strained.
TuningState tuning_state(const Model& model, const Points& x, double yield_strain);

}  // namespace coapt
