#include "optim/bfgs.hpp"

#include "core/error.hpp"
#include "optim/line_search.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

// Approximate inverse Hessian; only its lower triangle is kept up to date.
class InverseHessian {
 public:
  explicit InverseHessian(Eigen::Index size) : h_(Eigen::MatrixXd::Identity(size, size)) {}

  bool is_fresh() const { return is_fresh_; }

  void reset() {
    h_.setIdentity();
    is_fresh_ = true;
  }

  Vector direction(const Vector& g) const {
    return is_fresh_ ? Vector(-g) : Vector(-(h_.selfadjointView<Eigen::Lower>() * g));
  }

  // Nocedal & Wright 2006, eq. 6.17 multiplied out into two symmetric rank updates. Pairs without
  // curvature beyond round-off are left out: they would make the matrix indefinite.
  void update(const Vector& s, const Vector& y) {
    const double sy = s.dot(y);
    if (sy <= 1e-14 * s.norm() * y.norm()) return;
    if (is_fresh_) h_ *= sy / y.squaredNorm();  // eq. 6.20: the scale of the first step
    is_fresh_ = false;
    const Vector Hy = h_.selfadjointView<Eigen::Lower>() * y;
    h_.selfadjointView<Eigen::Lower>().rankUpdate(s, Hy, -1 / sy);
    h_.selfadjointView<Eigen::Lower>().rankUpdate(s, (1 + y.dot(Hy) / sy) / sy);
  }

 private:
  Eigen::MatrixXd h_;
  bool is_fresh_ = true;
};

class SolverBfgs final : public Solver {
 public:
  explicit SolverBfgs(const BfgsOptions& options) : options_(options) {}

  std::string_view name() const override { return "bfgs"; }
  bool follows_path() const override { return true; }

  Status minimize(Objective&, Vector& q, Monitor& monitor) override {
    if (q.size() > options_.max_unknowns)
      throw InputError("solver \"bfgs\" keeps a dense matrix and takes at most " +
                       std::to_string(options_.max_unknowns) + " unknowns; this problem has " +
                       std::to_string(q.size()) + ": use \"lbfgs\"");
    InverseHessian inverse(q.size());
    LinePoint at, next;
    at.q = q;
    at.energy = monitor.gradient(at.q, at.g);
    while (true) {
      if (const auto status = monitor.accept(at.q, at.energy, at.g)) return *status;
      const Vector direction = descent_direction(inverse, at, monitor);
      if (!search_line(monitor, at, direction, first_step(inverse, at.q, direction), next)) {
        if (monitor.is_out_of_time()) return Status::TimeLimit;
        if (inverse.is_fresh()) return Status::LineSearchFailed;
        inverse.reset();  // start afresh from steepest descent before giving up
        continue;
      }
      {
        PhaseTimer timer(monitor.phases(), "direction");
        inverse.update(next.q - at.q, next.g - at.g);
      }
      std::swap(at, next);
      q = at.q;
    }
  }

 private:
  static Vector descent_direction(InverseHessian& inverse, LinePoint& at, Monitor& monitor) {
    PhaseTimer timer(monitor.phases(), "direction");
    Vector direction = inverse.direction(at.g);
    at.slope = at.g.dot(direction);
    if (!(at.slope < 0)) {  // round-off has eaten the positive curvature
      inverse.reset();
      direction = -at.g;
      at.slope = -at.g.squaredNorm();
    }
    return direction;
  }

  // Without curvature the length of the step is a guess: 1 % of the size of the unknowns.
  static double first_step(const InverseHessian& inverse, const Vector& q, const Vector& direction) {
    if (!inverse.is_fresh()) return 1;
    const double spread = std::max(q.maxCoeff() - q.minCoeff(), 1e-12);
    return std::min(1.0, 0.01 * spread / direction.lpNorm<Eigen::Infinity>());
  }

  BfgsOptions options_;
};

}  // namespace

std::unique_ptr<Solver> make_bfgs(const BfgsOptions& options) {
  return std::make_unique<SolverBfgs>(options);
}

}  // namespace coapt
