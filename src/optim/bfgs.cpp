#include "optim/bfgs.hpp"

#include "core/error.hpp"
#include "optim/quasi_newton.hpp"

namespace coapt {
namespace {

// The whole matrix; only its lower triangle is kept up to date.
class DenseInverse final : public InverseHessian {
 public:
  explicit DenseInverse(Eigen::Index size) : h_(Eigen::MatrixXd::Identity(size, size)) {}

  bool is_empty() const override { return is_empty_; }

  void clear() override {
    h_.setIdentity();
    is_empty_ = true;
  }

  Vector direction(const Vector& g) override {
    return is_empty_ ? Vector(-g) : Vector(-(h_.selfadjointView<Eigen::Lower>() * g));
  }

  // Nocedal & Wright 2006, eq. 6.17 multiplied out into two symmetric rank updates.
  void learn(const Vector& s, const Vector& y) override {
    if (!has_curvature(s, y)) return;
    const double sy = s.dot(y);
    if (is_empty_) h_ *= sy / y.squaredNorm();  // eq. 6.20: the scale of the first step
    is_empty_ = false;
    const Vector Hy = h_.selfadjointView<Eigen::Lower>() * y;
    h_.selfadjointView<Eigen::Lower>().rankUpdate(s, Hy, -1 / sy);
    h_.selfadjointView<Eigen::Lower>().rankUpdate(s, (1 + y.dot(Hy) / sy) / sy);
  }

 private:
  Eigen::MatrixXd h_;
  bool is_empty_ = true;
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
    DenseInverse inverse(q.size());
    return descend(inverse, q, monitor);
  }

 private:
  BfgsOptions options_;
};

}  // namespace

std::unique_ptr<Solver> make_bfgs(const BfgsOptions& options) {
  return std::make_unique<SolverBfgs>(options);
}

}  // namespace coapt
