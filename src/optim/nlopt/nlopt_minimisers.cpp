#include "optim/nlopt/nlopt_minimisers.hpp"

#include <nlopt.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace coapt {
namespace {

constexpr double kFirstProbe = 0.05;  // of the width of the bounds, without derivatives
constexpr double kLastProbe =
    0.25;  // of COBYLA, over the least step: its error is as large as its probes reach

// What NLopt minimises: the function over its value at the start, so that its own scales fit. Where it cannot
// be evaluated there is a wall that leads back to the best place so far.
struct Hosted {
  BoundedFunction& function;
  double unit = 1;
  Vector best;
  double least = kInfinity, greatest = 0;

  double evaluate(const std::vector<double>& z, std::vector<double>& gradient) {
    const auto size = static_cast<Eigen::Index>(z.size());
    // NLopt may ask a rounding beyond a bound.
    const Vector at =
        Eigen::Map<const Vector>(z.data(), size).cwiseMax(function.low()).cwiseMin(function.high());
    // It may also go on asking for a while after it was told to stop.
    if (function.is_over()) throw nlopt::forced_stop();
    Vector slope;
    double value = function.value(at, gradient.empty() ? nullptr : &slope);
    if (function.is_over()) throw nlopt::forced_stop();
    if (std::isfinite(value)) {
      if (value < least) {
        least = value;
        best = at;
      }
      greatest = std::max(greatest, value);
    } else {
      value = 2 * greatest + unit * (at - best).squaredNorm();
      slope = 2 * unit * (at - best);
    }
    if (!gradient.empty()) Eigen::Map<Vector>(gradient.data(), size) = slope / unit;
    return value / unit;
  }
};

double call(const std::vector<double>& z, std::vector<double>& gradient, void* context) {
  return static_cast<Hosted*>(context)->evaluate(z, gradient);
}

std::string words(nlopt::result result) {
  switch (result) {
    case nlopt::FTOL_REACHED:
      return "the value changes no more";
    case nlopt::STOPVAL_REACHED:
      return "the value is as low as is asked for";
    case nlopt::XTOL_REACHED:
      return "the variables change no more";
    default:
      return "the method's own end";
  }
}

class NloptMinimiser final : public BoundedMinimiser {
 public:
  NloptMinimiser(std::string name, nlopt::algorithm algorithm)
      : name_(std::move(name)), algorithm_(algorithm) {}

  std::string_view name() const override { return name_; }
  bool needs_residuals() const override { return false; }

  BoundedOutcome minimise(BoundedFunction& function, const Vector& start, const BoundedStop& stop) override {
    const double first = function.value(start, nullptr);
    if (!std::isfinite(first)) return {false, "the start cannot be evaluated"};
    if (first == 0) return {true, "nothing is left to gain"};
    Hosted hosted{function, std::abs(first), start, first, first};
    const auto list = [](const Vector& v) { return std::vector<double>(v.begin(), v.end()); };
    nlopt::opt optimiser(algorithm_, static_cast<unsigned>(start.size()));
    optimiser.set_min_objective(&call, &hosted);
    optimiser.set_lower_bounds(list(function.low()));
    optimiser.set_upper_bounds(list(function.high()));
    optimiser.set_xtol_abs(stop.step);
    optimiser.set_ftol_rel(stop.gain);
    if (stop.enough > 0) optimiser.set_stopval(stop.enough / hosted.unit);
    if (algorithm_ == nlopt::LN_COBYLA) {
      optimiser.set_xtol_abs(kLastProbe * stop.step);
      const double width = (function.high() - function.low()).maxCoeff();
      if (width > 0) optimiser.set_initial_step(std::max(kFirstProbe * width, stop.step));
    }
    std::vector<double> z = list(start);
    double value = 0;
    try {
      return {true, words(optimiser.optimize(z, value))};
    } catch (const nlopt::forced_stop&) {
      return {false, "stopped"};
    } catch (const nlopt::roundoff_limited&) {
      return {false, "round-off lets the method go no further"};
    } catch (const std::runtime_error&) {  // NLopt's bare FAILURE: its line search is at its end
      return {false, "the method's line search finds nothing better"};
    }
  }

 private:
  std::string name_;
  nlopt::algorithm algorithm_;
};

}  // namespace

void add_nlopt_minimisers(BoundedMinimiserTable& table) {
  const auto add = [&](const std::string& name, nlopt::algorithm algorithm) {
    table[name] = [=] { return std::make_unique<NloptMinimiser>(name, algorithm); };
  };
  add("slsqp", nlopt::LD_SLSQP);
  add("mma", nlopt::LD_MMA);
  add("lbfgs", nlopt::LD_LBFGS);
  add("cobyla", nlopt::LN_COBYLA);
}

}  // namespace coapt
