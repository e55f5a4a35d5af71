#include "optim/ceres/ceres_least_squares.hpp"

#include <ceres/ceres.h>

#include <limits>

namespace coapt {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

class Residuals final : public ceres::CostFunction {
 public:
  Residuals(BoundedFunction& function, Eigen::Index variables, Eigen::Index count) : function_(function) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(variables));
    set_num_residuals(static_cast<int>(count));
  }

  // False: "cannot be evaluated here"; the step is then rejected.
  bool Evaluate(double const* const* z, double* residuals, double** jacobians) const override {
    const auto size = static_cast<Eigen::Index>(parameter_block_sizes().front());
    const bool wants_jacobian = jacobians != nullptr && jacobians[0] != nullptr;
    const Vector at = Eigen::Map<const Vector>(z[0], size);
    Vector r;
    Eigen::MatrixXd J;
    if (function_.is_over() || !function_.residuals(at, r, wants_jacobian ? &J : nullptr)) return false;
    Eigen::Map<Vector>(residuals, r.size()) = r;
    if (wants_jacobian) Eigen::Map<RowMajor>(jacobians[0], J.rows(), J.cols()) = J;
    return true;
  }

 private:
  BoundedFunction& function_;
};

class EndOnWish final : public ceres::IterationCallback {
 public:
  EndOnWish(const BoundedFunction& function, double enough) : function_(function), enough_(enough) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    if (function_.is_over()) return ceres::SOLVER_ABORT;
    return 2 * summary.cost <= enough_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const BoundedFunction& function_;
  double enough_;
};

class CeresLeastSquares final : public BoundedMinimiser {
 public:
  std::string_view name() const override { return "ceres"; }
  bool needs_residuals() const override { return true; }

  BoundedOutcome minimise(BoundedFunction& function, const Vector& start, const BoundedStop& stop) override {
    Vector z = start, r;
    if (!function.residuals(z, r, nullptr)) return {false, "the start cannot be evaluated"};
    ceres::Problem problem;
    problem.AddResidualBlock(new Residuals(function, z.size(), r.size()), nullptr, z.data());
    for (int i = 0; i < static_cast<int>(z.size()); ++i) {
      problem.SetParameterLowerBound(z.data(), i, function.low()[i]);
      problem.SetParameterUpperBound(z.data(), i, function.high()[i]);
    }
    EndOnWish end(function, stop.enough);
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.function_tolerance = stop.gain;
    options.gradient_tolerance = 0;
    options.parameter_tolerance = z.norm() > 0 ? stop.step / z.norm() : stop.step;
    options.max_num_iterations = std::numeric_limits<int>::max();
    options.logging_type = ceres::SILENT;
    options.callbacks.push_back(&end);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (function.is_over()) return {false, "stopped"};
    const bool has_converged =
        summary.termination_type == ceres::CONVERGENCE || summary.termination_type == ceres::USER_SUCCESS;
    return {has_converged, summary.message};
  }
};

}  // namespace

void add_ceres_minimiser(BoundedMinimiserTable& table) {
  table["ceres"] = [] { return std::make_unique<CeresLeastSquares>(); };
}

}  // namespace coapt
