// An equilibrium's cost as a function of its scaled numbers: one warm solve each. Private to this room.
#pragma once

#include "sensitivity/tuning.hpp"

namespace coapt {

class TuningTrials final : public BoundedFunction {
 public:
  // All must outlive this object. Pre: tune()'s checks.
  TuningTrials(const EquilibriumMaker& make, const Vector& q, const TuningGoal& goal,
               const TuningOptions& options, const Vector& first);

  // Solves at the start, or where the known record ends. False: it did not; see failure().
  bool begin();
  Vector first() const { return scaled(best_.value); }  // where the method begins
  const std::string& failure() const { return failure_; }

  const Vector& low() const override { return low_; }
  const Vector& high() const override { return high_; }
  double value(const Vector& z, Vector* gradient) override;
  bool has_residuals() const override { return goal_.residuals != nullptr && goal_.metrics.empty(); }
  bool residuals(const Vector& z, Vector& r, Eigen::MatrixXd* jacobian) override;
  bool is_over() const override { return end_.has_value(); }

  std::optional<TuningStatus> end() const { return end_; }  // the limit that ended it
  const TuningRecord& record() const { return best_; }
  double least() const { return least_; }
  double seconds() const;  // of all sessions
  // Of the residuals alone by z, at the best, and these; empty where that cannot be had.
  Eigen::MatrixXd best_jacobian(Vector& residuals);
  // The best shape against the first of this session, see Tuning::anchor.
  std::optional<AnchorCheck> check_anchor();

 private:
  Vector scaled(const Vector& value) const { return value.cwiseProduct(options_.scales); }
  bool solve(const Vector& z);  // whether z is solved, by this call or the last one
  bool take_up_best();
  void take_up_start();
  bool has_ended();  // a limit is reached
  bool attempt(const Vector& z);
  void measure(TuningTrial& trial);
  bool gradient(Vector& gradient);
  bool jacobian(Eigen::MatrixXd& rows);  // of the residuals alone, at the present place

  const EquilibriumMaker& make_;
  const TuningGoal& goal_;
  const TuningOptions& options_;
  Vector first_, low_, high_, change_weights_;
  std::unique_ptr<TrackedEquilibrium> equilibrium_;
  TuningRecord best_;
  Vector anchor_value_, anchor_q_;  // where this session began
  double least_ = kInfinity;
  Vector z_, r_;              // of the last trial, and its residuals
  double cost_ = kInfinity;   // of the last trial
  bool is_at_best_ = false;   // the equilibrium is solved there
  bool is_current_ = false;   // ... is solved at z_
  Eigen::MatrixXd jacobian_;  // of the residuals, at z_of_jacobian_
  Vector z_of_jacobian_, r_of_jacobian_;
  std::optional<TuningStatus> end_;
  double begin_s_ = 0, seconds_before_ = 0;
  std::string failure_;
};

}  // namespace coapt
