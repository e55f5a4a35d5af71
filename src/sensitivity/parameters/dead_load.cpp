#include "sensitivity/parameters/dead_load.hpp"

#include "core/error.hpp"
#include "energy/load_dead.hpp"

namespace coapt {
namespace {

// Forces that are any linear function of the numbers; the derived classes say which.
class DeadLoad : public Parameter {
 public:
  DeadLoad(std::string name, LoadDead& load, Vector value)
      : Parameter(std::move(name)), load_(load), value_(std::move(value)) {}

  Vector value() const final { return value_; }

  std::string defect(const Vector& value) const final {
    return value.allFinite() ? "" : "parameter \"" + name() + "\": every number must be finite";
  }

  void set(const Vector& value) final {
    value_ = value;
    load_.set_forces(forces_for(value));
  }

  std::vector<WrittenDatum> written() const final { return whole_term(WrittenDatum::Kind::Force, load_); }

  // g = -f on each loaded node.
  Vector pull_back(const Points&, const Points& weights) const final {
    return by_numbers(-weights(Eigen::all, load_.stencils().nodes));
  }

  void push_forward(const Points&, const Vector& change, Points& g) const final {
    g(Eigen::all, load_.stencils().nodes) -= forces_for(change);
  }

  // W = -sum of f . (x - X).
  Vector energy_derivative(const Points& x, const EnergyTerm& term) const final {
    if (&term != &load_) return none();
    return by_numbers(load_.reference() - x(Eigen::all, load_.stencils().nodes));
  }

 private:
  virtual Points forces_for(const Vector& value) const = 0;
  // The transpose: derivative by the numbers of the sum of forces . weights.
  virtual Vector by_numbers(const Points& weights) const = 0;

  LoadDead& load_;
  Vector value_;
};

class LoadFactor final : public DeadLoad {
 public:
  LoadFactor(std::string name, LoadDead& load)
      : DeadLoad(std::move(name), load, Vector::Ones(1)), first_(load.forces()) {}

 private:
  Points forces_for(const Vector& value) const override { return value[0] * first_; }
  Vector by_numbers(const Points& weights) const override {
    return Vector::Constant(1, first_.cwiseProduct(weights).sum());
  }

  Points first_;  // when the parameter was made
};

class NodalForces final : public DeadLoad {
 public:
  NodalForces(std::string name, LoadDead& load) : DeadLoad(std::move(name), load, load.forces().reshaped()) {}

 private:
  Points forces_for(const Vector& value) const override {
    return Eigen::Map<const Points>(value.data(), 3, value.size() / 3);
  }
  Vector by_numbers(const Points& weights) const override { return weights.reshaped(); }
};

LoadDead& dead_load(const std::string& name, EnergyTerm& term) {
  if (is_dead_load(term)) return *access_of(term)->dead_load();
  throw InputError(
      "parameter \"" + name + "\": term \"" + term.name() + "\" (" + std::string(term.type()) +
      ") has no forces that keep their direction; name a load_field, or a load_pressure of model "
      "frozen, that loads a node");
}

}  // namespace

bool is_dead_load(EnergyTerm& term) {
  TermAccess* access = access_of(term);
  return access != nullptr && access->dead_load() != nullptr && term.stencils().count() > 0;
}

std::unique_ptr<Parameter> make_load_factor(std::string name, EnergyTerm& term) {
  LoadDead& load = dead_load(name, term);
  return std::make_unique<LoadFactor>(std::move(name), load);
}

std::unique_ptr<Parameter> make_nodal_forces(std::string name, EnergyTerm& term) {
  LoadDead& load = dead_load(name, term);
  return std::make_unique<NodalForces>(std::move(name), load);
}

}  // namespace coapt
