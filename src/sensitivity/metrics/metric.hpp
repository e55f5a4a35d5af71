// A figure of merit of a shape, with its exact derivative.
#pragma once

#include "sensitivity/parameters/parameter.hpp"

#include <functional>
#include <string>

namespace coapt {

class Metric {
 public:
  explicit Metric(std::string name) : name_(std::move(name)) {}
  virtual ~Metric() = default;
  Metric(const Metric&) = delete;
  Metric& operator=(const Metric&) = delete;

  const std::string& name() const { return name_; }

  // Value at x (3 x node_count positions), and its derivative by x where `gradient` is not null (same size;
  // overwritten).
  virtual double evaluate(const Points& x, Points* gradient) const = 0;

  // Derivative by the numbers of a parameter at fixed positions, of a metric that depends on more than these.
  virtual Vector partial(const Parameter& parameter, const Points& /*x*/) const {
    return Vector::Zero(parameter.value().size());
  }

 private:
  std::string name_;
};

// A metric of the user's own: value, and gradient where it is not null (3 x node_count zeros on entry).
class UserMetric final : public Metric {
 public:
  using Function = std::function<double(const Points& x, Points* gradient)>;

  UserMetric(std::string name, Function function) : Metric(std::move(name)), function_(std::move(function)) {}

  double evaluate(const Points& x, Points* gradient) const override {
    if (gradient != nullptr) gradient->setZero(3, x.cols());
    return function_(x, gradient);
  }

 private:
  Function function_;
};

}  // namespace coapt
