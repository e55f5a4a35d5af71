#include "optim/newton.hpp"

#include "optim/gmres.hpp"
#include "optim/line_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace coapt {
namespace {
double knob(const char* name, double fallback) {
  const char* text = std::getenv(name);
  return text ? std::atof(text) : fallback;
}

class SolverNewton final : public Solver {
 public:
  explicit SolverNewton(const NewtonOptions& options) : options_(options) {}

  std::string_view name() const override { return "newton"; }
  bool follows_path() const override { return true; }

  Status minimize(Objective& objective, Vector& q, Monitor& monitor) override {
    auto factor = options_.factorisation();
    Gmres gmres(30);
    SparseMatrix h;
    LinePoint at, next;
    at.q = q;
    Vector direction, preconditioned, rhs;
    long version = -1;
    const bool verbose = knob("NV", 0) > 0;
    double mu = knob("MU0", 1);
    const double down = knob("DOWN", 0.1), up = knob("UP", 4), floor_mu = knob("MUMIN", 0);
    const double forcing = knob("FORCE", 1e-3);
    at.energy = monitor.gradient(at.q, at.g);
    double scale = 0;
    while (true) {
      if (const auto status = monitor.accept(at.q, at.energy, at.g)) return *status;
      const double residual = objective.relative_residual(at.g);
      if (scale == 0) scale = objective.reference_force() / (at.q.maxCoeff() - at.q.minCoeff());
      bool exact = true;
      int tries = 0;
      monitor.hessian(at.q, at.g, h, Projection::None);
      if (objective.pattern_version() != version) {
        PhaseTimer timer(monitor.phases(), "analyse");
        factor->analyse(h);
        version = objective.pattern_version();
        diagonal_.clear();
        for (int c = 0; c < static_cast<int>(h.cols()); ++c) {
          const int* inner_index = h.innerIndexPtr();
          const auto at_diagonal =
              std::lower_bound(inner_index + h.outerIndexPtr()[c], inner_index + h.outerIndexPtr()[c + 1], c);
          diagonal_.push_back(static_cast<int>(at_diagonal - inner_index));
        }
      }
      double added = 0;
      double mean_diag = 0;
      for (int k : diagonal_) mean_diag += h.valuePtr()[k];
      mean_diag /= double(diagonal_.size());
      while (true) {
        const double wanted = std::max(mu * scale, 1e-11 * mean_diag);
        for (int k : diagonal_) h.valuePtr()[k] += wanted - added;
        added = wanted;
        bool ok;
        {
          PhaseTimer timer(monitor.phases(), "factorise");
          ok = factor->factorise(h);
          monitor.count_factorisation();
        }
        if (ok) break;
        ++tries;
        if (exact && knob("PROJ", 1) > 0) {
          exact = false;
          monitor.hessian(at.q, at.g, h, Projection::PositiveSemidefinite);
          added = 0;
        } else
          mu = std::max(10 * mu, 1e-9);
        if (mu > 1e12) return Status::Stalled;
      }
      int inner = 0;
      {
        PhaseTimer timer(monitor.phases(), "direction");
        rhs = -at.g;
        factor->solve(rhs, preconditioned);
        if (objective.has_skew_tangent())
          inner = gmres.solve(
              [&](const Vector& v, Vector& out) {
                rhs.setZero();
                objective.add_skew_product(v, rhs);
                factor->solve(rhs, out);
              },
              preconditioned, forcing, direction);
        else
          direction = preconditioned;
        at.slope = at.g.dot(direction);
      }
      if (!(at.slope < 0)) {
        if (verbose) std::printf("not descent\n");
        direction = preconditioned;
        at.slope = at.g.dot(direction);
      }
      if (!search_line(monitor, at, direction, 1, next)) {
        if (monitor.is_out_of_time()) return Status::TimeLimit;
        mu = std::max(10 * mu, 1e-6);
        if (verbose) std::printf("line search failed, mu %g\n", mu);
        if (mu > 1e6) return Status::LineSearchFailed;
        continue;
      }
      if (verbose)
        std::printf("%3d res %.2e E %.9g mu %.1e tries %d exact %d inner %d step %.3g |d| %.2e\n",
                    monitor.iterations(), residual, at.energy, mu, tries, exact, inner, next.step,
                    direction.lpNorm<Eigen::Infinity>());
      const double model = at.slope * next.step * (1 - 0.5 * next.step);
      const double ratio = (next.energy - at.energy) / model;
      if (next.step >= 0.9 && ratio > 0.5)
        mu = std::max(floor_mu, mu * down);
      else if (next.step < 0.3)
        mu = std::max(mu * up, 1e-9);
      std::swap(at, next);
      q = at.q;
    }
  }

 private:
  NewtonOptions options_;
  std::vector<int> diagonal_;
};

}  // namespace

std::unique_ptr<Solver> make_newton(const NewtonOptions& options) {
  return std::make_unique<SolverNewton>(options);
}

}  // namespace coapt
