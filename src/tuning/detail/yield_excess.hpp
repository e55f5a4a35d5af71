// By how much chords and orifice exceed what is wanted of them. Private to this room.
#pragma once

#include "sensitivity/metrics/residual_set.hpp"
#include "tuning/region_tuning.hpp"

namespace coapt {

// One residual for each line with a rest length and a yield, one for each facet with one where all count by
// their own yield, and one for the orifice where it has a limit: how far strain or area are above their
// limits less a margin, relative to these; 0 below. Derivatives are exact with the view on the orifice held,
// as it is where the annulus is prescribed.
class YieldExcess final : public ResidualSet {
 public:
  // model: its lines, mesh and annulus; must outlive this object, and rest lengths may not change.
  // yield_strain: of every line; empty: each line and each facet its own, those without one do not count.
  YieldExcess(const Model& model, std::optional<double> yield_strain,
              std::optional<double> orifice_limit_mm2);

  Vector values(const Points& x) const override;
  Eigen::MatrixXd derivatives(const Points& x, const std::vector<Points>& motions) const override;
  Points pull_back(const Points& x, const Vector& weights) const override;

  // A sum of squares below which nothing is beyond its limit.
  static double enough();

 private:
  struct Excess {
    Vector values;   // of all residuals
    Points of_line;  // derivative of each line's value by the place of its first end
    Eigen::Matrix<double, 9, Eigen::Dynamic> of_facet;  // of each facet's value by its corners
    Points of_orifice;                                  // of the last value, by all nodes
  };
  Excess excess(const Points& x, bool wants_derivatives) const;

  const Model& model_;
  std::optional<double> yield_strain_, limit_;
  std::vector<size_t> lines_;  // of the model, that count
  struct Facet {
    const MembranePatch* patch;
    int element;
  };
  std::vector<Facet> facets_;
};

// The figures themselves, with the strain beyond which a chord counts as strained; empty: of each its own.
TuningState tuning_state(const Model& model, const Points& x, std::optional<double> yield_strain);

}  // namespace coapt
