#include "optim/lbfgs.hpp"

#include "optim/quasi_newton.hpp"
#include "optim/shifted_hessian.hpp"

#include <algorithm>
#include <deque>
#include <optional>

namespace coapt {
namespace {

// The last few pairs, newest at the back, and what the recursion starts from.
class LimitedMemory final : public InverseHessian {
 public:
  LimitedMemory(const SolverOptions& options, Objective& objective, Monitor& monitor)
      : capacity_(static_cast<size_t>(options.memory)), objective_(objective), monitor_(monitor) {
    if (options.is_preconditioned) metric_.emplace(options.factorisation);
  }

  // Renews the metric now and then; the pairs stay valid whatever the metric is.
  void visit(const Vector& q) override {
    if (!metric_ || age_++ % kRenewal != 0) return;
    if (unit_ == 0) unit_ = objective_.reference_force(q) / std::max(objective_.extent(q), 1e-12);
    double shift = (has_metric_ ? kLaterShift : kFirstShift) * unit_;
    has_metric_ = metric_->factorise(objective_, monitor_, q, work_, shift);
  }

  bool is_empty() const override { return pairs_.empty() && !has_metric_; }

  // The pairs first, and if that was not enough the metric.
  void clear() override {
    if (pairs_.empty()) has_metric_ = false;
    pairs_.clear();
  }

  void learn(const Vector& s, const Vector& y) override {
    if (!has_curvature(s, y)) return;
    if (pairs_.size() == capacity_) pairs_.pop_front();
    pairs_.push_back({s, y, 1 / s.dot(y)});
  }

  // The two-loop recursion (Nocedal & Wright 2006, algorithm 7.4).
  Vector direction(const Vector& g) override {
    Vector d = -g;
    std::vector<double> alpha(pairs_.size());
    for (size_t k = pairs_.size(); k-- > 0;) {
      alpha[k] = pairs_[k].rho * pairs_[k].s.dot(d);
      d -= alpha[k] * pairs_[k].y;
    }
    if (has_metric_) {
      metric_->solve(d, work_);
      d = work_;
    } else if (!pairs_.empty()) {
      d *= 1 / (pairs_.back().rho * pairs_.back().y.squaredNorm());
    }
    for (size_t k = 0; k < pairs_.size(); ++k)
      d += (alpha[k] - pairs_[k].rho * pairs_[k].y.dot(d)) * pairs_[k].s;
    return d;
  }

 private:
  static constexpr int kRenewal = 25;  // iterations after which the preconditioner is factorised anew
  // Shifts of the first factor and of later ones, times force over length.
  static constexpr double kFirstShift = 1, kLaterShift = 1e-2;

  struct Pair {
    Vector s, y;
    double rho;
  };
  size_t capacity_;
  std::deque<Pair> pairs_;
  Objective& objective_;
  Monitor& monitor_;
  std::optional<ShiftedHessian> metric_;  // with `preconditioned` alone
  bool has_metric_ = false;
  int age_ = 0;
  double unit_ = 0;  // force over length of the scene
  Vector work_;
};

class SolverLbfgs final : public Solver {
 public:
  explicit SolverLbfgs(const SolverOptions& options) : options_(options) {}

  std::string_view name() const override { return "lbfgs"; }
  bool follows_path() const override { return true; }

  Status minimize(Objective& objective, Vector& q, Monitor& monitor) override {
    LimitedMemory memory(options_, objective, monitor);
    return descend(memory, q, monitor);
  }

 private:
  SolverOptions options_;
};

}  // namespace

std::unique_ptr<Solver> make_lbfgs(const SolverOptions& options) {
  return std::make_unique<SolverLbfgs>(options);
}

}  // namespace coapt
