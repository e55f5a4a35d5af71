#include "optim/lbfgs.hpp"

#include "optim/line_search.hpp"

#include <algorithm>
#include <deque>

namespace coapt {
namespace {

// The last few steps and changes of the gradient, newest at the back.
class CurvatureMemory {
 public:
  explicit CurvatureMemory(int capacity) : capacity_(static_cast<size_t>(capacity)) {}

  void clear() { pairs_.clear(); }
  bool is_empty() const { return pairs_.empty(); }

  // Keeps the pair if the curvature along it is positive beyond round-off.
  void add(Vector s, Vector y) {
    const double sy = s.dot(y);
    if (sy <= 1e-14 * s.norm() * y.norm()) return;
    if (pairs_.size() == capacity_) pairs_.pop_front();
    pairs_.push_back({std::move(s), std::move(y), 1 / sy});
  }

  // -H g by the two-loop recursion (Nocedal & Wright 2006, algorithm 7.4).
  Vector direction(const Vector& g) const {
    Vector d = -g;
    std::vector<double> alpha(pairs_.size());
    for (size_t k = pairs_.size(); k-- > 0;) {
      alpha[k] = pairs_[k].rho * pairs_[k].s.dot(d);
      d -= alpha[k] * pairs_[k].y;
    }
    if (!pairs_.empty()) {
      const Pair& newest = pairs_.back();
      d *= 1 / (newest.rho * newest.y.squaredNorm());
    }
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
    CurvatureMemory memory(options_.memory);
    LinePoint at, next;
    at.q = q;
    at.energy = monitor.gradient(at.q, at.g);
    while (true) {
      if (const auto status = monitor.accept(at.q, at.energy, at.g)) return *status;
      q = at.q;
      Vector direction;
      {
        PhaseTimer timer(monitor.phases(), "direction");
        direction = memory.direction(at.g);
        at.slope = at.g.dot(direction);
        if (!(at.slope < 0)) {
          memory.clear();
          direction = -at.g;
          at.slope = -at.g.squaredNorm();
        }
      }
      // Without curvature the length of the step is a guess: try 1 % of the size of the unknowns.
      const double first =
          memory.is_empty() ? std::min(1.0, 0.01 * spread(at.q) / direction.lpNorm<Eigen::Infinity>()) : 1.0;
      if (!search_line(monitor, at, direction, first, next)) {
        if (monitor.is_out_of_time()) return Status::TimeLimit;
        if (memory.is_empty()) return Status::LineSearchFailed;
        memory.clear();  // start afresh from steepest descent before giving up
        continue;
      }
      {
        PhaseTimer timer(monitor.phases(), "direction");
        memory.add(next.q - at.q, next.g - at.g);
      }
      std::swap(at, next);
      q = at.q;
    }
  }

 private:
  static double spread(const Vector& q) {
    return q.size() == 0 ? 0 : std::max(q.maxCoeff() - q.minCoeff(), 1e-12);
  }

  LbfgsOptions options_;
};

}  // namespace

std::unique_ptr<Solver> make_lbfgs(const LbfgsOptions& options) {
  return std::make_unique<SolverLbfgs>(options);
}

}  // namespace coapt
