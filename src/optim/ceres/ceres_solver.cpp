#include "optim/ceres/ceres_solver.hpp"

#include "optim/external_solver_run.hpp"

#include <ceres/ceres.h>

#include <cmath>
#include <limits>

namespace coapt {
namespace {

using ConstVectorMap = Eigen::Map<const Vector>;

class HostedFunction final : public ceres::FirstOrderFunction {
 public:
  HostedFunction(ExternalSolverRun& run, int size) : run_(run), size_(size) {}
  int NumParameters() const override { return size_; }

  // False = "cannot be evaluated here": the line search then shortens its step.
  bool Evaluate(const double* z, double* cost, double* gradient) const override {
    *cost = run_.evaluate(ConstVectorMap(z, size_), g_);
    if (!std::isfinite(*cost)) return false;
    if (gradient != nullptr) Eigen::Map<Vector>(gradient, size_) = g_;
    return true;
  }

 private:
  ExternalSolverRun& run_;
  int size_;
  mutable Vector g_;
};

class IterateReport final : public ceres::IterationCallback {
 public:
  IterateReport(ExternalSolverRun& run, const Vector& z) : run_(run), z_(z) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return run_.accept(z_) ? ceres::SOLVER_CONTINUE : ceres::SOLVER_ABORT;
  }

 private:
  ExternalSolverRun& run_;
  const Vector& z_;  // Ceres writes every accepted iterate here
};

class SolverCeres final : public Solver {
 public:
  std::string_view name() const override { return "ceres"; }
  bool honours_step_limits() const override { return false; }

  Status minimize(Objective&, Vector& q, Monitor& monitor) override {
    ExternalSolverRun run(monitor, q);
    while (run.begin_attempt()) {
      Vector z = Vector::Zero(q.size());
      IterateReport report(run, z);
      ceres::GradientProblemSolver::Options options = silent_options();
      options.callbacks.push_back(&report);
      ceres::GradientProblemSolver::Summary summary;
      const ceres::GradientProblem problem(new HostedFunction(run, static_cast<int>(q.size())));
      ceres::Solve(options, problem, z.data(), &summary);
    }
    q = run.q();
    return run.status().value_or(Status::LineSearchFailed);
  }

 private:
  static ceres::GradientProblemSolver::Options silent_options() {
    ceres::GradientProblemSolver::Options options;
    options.line_search_direction_type = ceres::LBFGS;
    options.line_search_type = ceres::WOLFE;
    options.function_tolerance = 0;  // relative to an energy whose zero is arbitrary
    options.gradient_tolerance = 0;
    options.parameter_tolerance = 0;
    options.max_num_iterations = std::numeric_limits<int>::max();
    options.logging_type = ceres::SILENT;
    options.update_state_every_iteration = true;
    return options;
  }
};

}  // namespace

void add_ceres_solver(SolverTable& table) {
  table["ceres"] = [](const SolverOptions&) { return std::make_unique<SolverCeres>(); };
}

}  // namespace coapt
