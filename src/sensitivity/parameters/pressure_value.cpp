#include "sensitivity/parameters/pressure_value.hpp"

#include "core/error.hpp"
#include "energy/load_pressure.hpp"

#include <cmath>

namespace coapt {
namespace {

class PressureValue final : public Parameter {
 public:
  PressureValue(std::string name, EnergyTerm& term, double sign)
      : Parameter(std::move(name)), term_(term), sign_(sign) {}

  Vector value() const override { return Vector::Constant(1, sign_ * pressure()); }

  std::string defect(const Vector& value) const override {
    if (std::isfinite(value[0]) && sign_ * value[0] * pressure() > 0) return {};
    return "parameter \"" + name() + "\": the pressure must be finite, not zero, and keep its sign";
  }

  void set(const Vector& value) override { set_pressure(term_, sign_ * value[0]); }

  std::vector<WrittenDatum> written() const override { return {{WrittenDatum::Kind::Pressure, &term_, 0}}; }

  Vector pull_back(const Points& x, const Points& weights) const override {
    return Vector::Constant(1, sign_ * slope(x).cwiseProduct(weights).sum());
  }

  void push_forward(const Points& x, const Vector& change, Points& g) const override {
    g += sign_ * change[0] * slope(x);
  }

  Vector energy_derivative(const Points& x, const EnergyTerm& term) const override {
    if (&term != &term_) return none();
    Sink sink;
    return Vector::Constant(1, sign_ * term_.evaluate(x, sink) / pressure());
  }

 private:
  double pressure() const { return *pressure_of(term_); }

  // The load is linear in the pressure.
  Points slope(const Points& x) const {
    Points g = Points::Zero(3, x.cols()), force = g;
    Sink sink(g.data());
    term_.evaluate(x, sink);
    term_.add_circulatory_force(x, force);
    return (g - force) / pressure();
  }

  EnergyTerm& term_;
  double sign_;
};

}  // namespace

std::unique_ptr<Parameter> make_pressure_value(std::string name, EnergyTerm& term, double sign) {
  const std::optional<double> p = pressure_of(term);
  if (!p)
    throw InputError("parameter \"" + name + "\": term \"" + term.name() + "\" (" + std::string(term.type()) +
                     ") is no pressure that follows the surface; name one of model follower or volume");
  if (*p == 0) throw InputError("parameter \"" + name + "\": the pressure is zero; give it a value first");
  return std::make_unique<PressureValue>(std::move(name), term, sign);
}

}  // namespace coapt
