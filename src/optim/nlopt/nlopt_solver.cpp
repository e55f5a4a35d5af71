#include "optim/nlopt/nlopt_solver.hpp"

#include "optim/external_solver_run.hpp"

#include <nlopt.hpp>

#include <stdexcept>
#include <vector>

namespace coapt {
namespace {

class SolverNlopt final : public Solver {
 public:
  std::string_view name() const override { return "nlopt"; }
  bool honours_step_limits() const override { return false; }

  Status minimize(Objective&, Vector& q, Monitor& monitor) override {
    ExternalSolverRun run(monitor, q);
    bool is_lead = true;
    while (run.begin_attempt()) {
      attempt(is_lead ? nlopt::LD_TNEWTON_PRECOND_RESTART : nlopt::LD_LBFGS, run);
      is_lead = !is_lead;
    }
    q = run.q();
    return run.status().value_or(Status::LineSearchFailed);
  }

 private:
  static void attempt(nlopt::algorithm algorithm, ExternalSolverRun& run) {
    std::vector<double> z(static_cast<size_t>(run.q().size()), 0.0);
    nlopt::opt optimiser(algorithm, static_cast<unsigned>(z.size()));
    optimiser.set_min_objective(&evaluate, &run);
    try {
      double energy = 0;
      optimiser.optimize(z, energy);
    } catch (const nlopt::forced_stop&) {  // the monitor's word; run.status() has it
    } catch (const nlopt::roundoff_limited&) {
    } catch (const std::runtime_error&) {  // NLopt's bare FAILURE: its line search is at its end
    }
  }

  static double evaluate(const std::vector<double>& z, std::vector<double>& gradient, void* context) {
    ExternalSolverRun& run = *static_cast<ExternalSolverRun*>(context);
    const auto size = static_cast<Eigen::Index>(z.size());
    Vector g;
    const double energy = run.evaluate(Eigen::Map<const Vector>(z.data(), size), g);
    if (!gradient.empty()) Eigen::Map<Vector>(gradient.data(), size) = g;
    if (energy < kInfinity) run.accept_if_better();
    if (run.status()) throw nlopt::forced_stop();
    return energy;
  }
};

}  // namespace

void add_nlopt_solver(SolverTable& table) {
  table["nlopt"] = [](const SolverOptions&) { return std::make_unique<SolverNlopt>(); };
}

}  // namespace coapt
