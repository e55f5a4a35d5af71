#include "optim/lbfgs.hpp"

#include "optim/quasi_newton.hpp"

#include <deque>

namespace coapt {
namespace {

// The last few pairs, newest at the back.
class LimitedMemory final : public InverseHessian {
 public:
  explicit LimitedMemory(int capacity) : capacity_(static_cast<size_t>(capacity)) {}

  bool is_empty() const override { return pairs_.empty(); }
  void clear() override { pairs_.clear(); }

  void learn(const Vector& s, const Vector& y) override {
    if (!has_curvature(s, y)) return;
    if (pairs_.size() == capacity_) pairs_.pop_front();
    pairs_.push_back({s, y, 1 / s.dot(y)});
  }

  // The two-loop recursion (Nocedal & Wright 2006, algorithm 7.4).
  Vector direction(const Vector& g) const override {
    Vector d = -g;
    if (pairs_.empty()) return d;
    std::vector<double> alpha(pairs_.size());
    for (size_t k = pairs_.size(); k-- > 0;) {
      alpha[k] = pairs_[k].rho * pairs_[k].s.dot(d);
      d -= alpha[k] * pairs_[k].y;
    }
    const Pair& newest = pairs_.back();
    d *= 1 / (newest.rho * newest.y.squaredNorm());
    for (size_t k = 0; k < pairs_.size(); ++k)
      d += (alpha[k] - pairs_[k].rho * pairs_[k].y.dot(d)) * pairs_[k].s;
    return d;
  }

 private:
  struct Pair {
    Vector s, y;
    double rho;
  };
  size_t capacity_;
  std::deque<Pair> pairs_;
};

class SolverLbfgs final : public Solver {
 public:
  explicit SolverLbfgs(const LbfgsOptions& options) : options_(options) {}

  std::string_view name() const override { return "lbfgs"; }
  bool follows_path() const override { return true; }

  Status minimize(Objective&, Vector& q, Monitor& monitor) override {
    LimitedMemory memory(options_.memory);
    return descend(memory, q, monitor);
  }

 private:
  LbfgsOptions options_;
};

}  // namespace

std::unique_ptr<Solver> make_lbfgs(const LbfgsOptions& options) {
  return std::make_unique<SolverLbfgs>(options);
}

}  // namespace coapt
