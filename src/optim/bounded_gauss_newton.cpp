#include "optim/bounded_minimiser.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <vector>

namespace coapt {
namespace {

constexpr double kLeastDamping = 1e-12;  // of the greatest diagonal of J^T J: keeps the system definite
constexpr double kMostDamping = 1e12;    // of the same: no smaller step is tried
constexpr double kLeastShare = 1e-3;     // of the gain that was to be expected, which a step must bring
constexpr double kFailedDamping = 10;    // factor on the damping after a failed step
constexpr double kWorthwhile = 1e-3;     // of the value, that a trial should gain
constexpr int kIdle = 6;                 // trials in a row that gain less: slow progress along a kink

using Indices = std::vector<Eigen::Index>;

class GaussNewton final : public BoundedMinimiser {
 public:
  std::string_view name() const override { return "gauss_newton"; }
  bool needs_residuals() const override { return true; }

  BoundedOutcome minimise(BoundedFunction& function, const Vector& start, const BoundedStop& stop) override {
    Vector z = start, r, r_there;
    Eigen::MatrixXd J;
    if (!function.residuals(z, r, &J)) return {false, "the start cannot be evaluated"};
    double damping = stop.damping, growth = 2;
    bool is_new = true;  // no trial from here has failed
    int idle = 0;        // trials in a row without a gain that is worth it
    while (!function.is_over()) {
      const double value = r.squaredNorm();
      if (value <= stop.enough) return {true, "the fit is as close as is asked for"};
      const Vector g = J.transpose() * r, low = function.low() - z, high = function.high() - z;
      const Eigen::MatrixXd A = J.transpose() * J;
      const double size = A.diagonal().maxCoeff();
      if (!(size > 0)) return {true, "nothing changes the fit"};
      const auto damped = [&](double share) {
        Eigen::MatrixXd of_step = A;
        of_step.diagonal().array() += share * size;
        return bounded_step(of_step, g, low, high);
      };
      const auto expected = [&](const Vector& step) { return value - (r + J * step).squaredNorm(); };
      if (is_new) {
        const Vector whole = damped(kLeastDamping);
        if (whole.cwiseAbs().maxCoeff() < stop.step || !(expected(whole) > stop.gain * value))
          return {true, "no step within the bounds is expected to improve the fit further"};
      }
      const Vector step = damped(std::max(damping, kLeastDamping));
      if (step.cwiseAbs().maxCoeff() < stop.step) {
        if (!is_new) return {true, "no step, however damped, improves the fit further"};
        damping /= kFailedDamping;
        continue;
      }
      const Vector there = (z + step).cwiseMax(function.low()).cwiseMin(function.high());
      const bool is_known = function.residuals(there, r_there, nullptr);
      if (function.is_over()) break;
      const double share = is_known ? (value - r_there.squaredNorm()) / expected(step) : -1;
      idle = is_known && r_there.squaredNorm() < (1 - kWorthwhile) * value ? 0 : idle + 1;
      if (share > kLeastShare) {
        z = there;
        if (!function.residuals(z, r, &J)) return {false, "the derivatives cannot be evaluated"};
        damping *= std::max(1.0 / 3, 1 - std::pow(2 * share - 1, 3));
        growth = 2;
        is_new = true;
      } else {
        damping *= is_known ? growth : kFailedDamping;
        growth *= 2;
        is_new = false;
        if (damping > kMostDamping) return {false, "no smaller step improves the fit either"};
      }
      if (idle >= kIdle) return {true, "trial after trial hardly improves the fit"};
    }
    return {false, "stopped"};
  }
};

}  // namespace

Vector bounded_step(const Eigen::MatrixXd& A, const Vector& g, const Vector& low, const Vector& high) {
  const Eigen::Index n = g.size();
  Vector s = Vector::Zero(n);
  std::vector<bool> is_held(static_cast<size_t>(n), false);
  for (Eigen::Index i = 0; i < n; ++i)
    is_held[static_cast<size_t>(i)] = (low[i] >= 0 && g[i] > 0) || (high[i] <= 0 && g[i] < 0);
  for (Eigen::Index change = 0; change < 10 * n + 10; ++change) {
    Indices free;
    for (Eigen::Index i = 0; i < n; ++i)
      if (!is_held[static_cast<size_t>(i)]) free.push_back(i);
    const Vector slope = g + A * s;
    Vector move = Vector::Zero(n);
    if (!free.empty()) {
      const Eigen::MatrixXd of_free = A(free, free);
      const Vector solved = of_free.ldlt().solve(-slope(free));
      move(free) = solved;
    }
    // As far as the first bound.
    double share = 1;
    Eigen::Index hit = -1;
    for (const Eigen::Index i : free) {
      const double room = move[i] > 0 ? high[i] - s[i] : low[i] - s[i];
      if (move[i] != 0 && room / move[i] < share) {
        share = std::max(0.0, room / move[i]);
        hit = i;
      }
    }
    s += share * move;
    if (hit >= 0) {
      s[hit] = move[hit] > 0 ? high[hit] : low[hit];
      is_held[static_cast<size_t>(hit)] = true;
      continue;
    }
    // The least among the free ones: whichever held one pulls inward most is let go.
    const Vector pull = g + A * s;
    const double noise = 1e-14 * (g.cwiseAbs().maxCoeff() + (A * s).cwiseAbs().maxCoeff());
    double most = noise;
    Eigen::Index released = -1;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!is_held[static_cast<size_t>(i)] || low[i] == high[i]) continue;
      const double inward = s[i] <= low[i] ? -pull[i] : pull[i];
      if (inward > most) {
        most = inward;
        released = i;
      }
    }
    if (released < 0) break;
    is_held[static_cast<size_t>(released)] = false;
  }
  return s.cwiseMax(low).cwiseMin(high);
}

BoundedMinimiserTable built_in_minimisers() {
  return {{"gauss_newton", [] { return std::make_unique<GaussNewton>(); }}};
}

}  // namespace coapt
