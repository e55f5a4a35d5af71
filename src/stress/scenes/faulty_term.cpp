#include "stress/scenes/faulty_term.hpp"

#include <memory>
#include <stdexcept>

namespace coapt {
namespace {

// Passes on to another term all that it is asked, and fails where it is told to.
class PassingTerm final : public EnergyTerm {
 public:
  // owner: of the inner term. rest: null: it never fails.
  PassingTerm(std::shared_ptr<Objective> owner, EnergyTerm& inner, std::shared_ptr<const Points> rest,
              Fault fault, double reach)
      : EnergyTerm(inner.name()),
        owner_(std::move(owner)),
        inner_(inner),
        rest_(std::move(rest)),
        fault_(fault),
        reach_(reach) {}

  std::string_view type() const override { return inner_.type(); }
  TermRole role() const override { return inner_.role(); }
  const Stencils& stencils() const override { return inner_.stencils(); }
  double evaluate(const Points& x, Sink& sink) const override {
    const bool fails = rest_ != nullptr && (x - *rest_).colwise().norm().maxCoeff() > reach_;
    if (fails && fault_ == Fault::Throws) throw std::runtime_error("this term was made to fail");
    const double energy = inner_.evaluate(x, sink);
    if (!fails) return energy;
    if (fault_ == Fault::NaN) return kNaN;
    if (fault_ == Fault::Infinity) return kInfinity;
    if (sink.wants_gradient())  // at every node: what a support prescribes is not looked at
      for (const int node : stencils().nodes) sink.add_gradient(node, Vec3::Constant(kNaN));
    return energy;
  }
  bool prepare(const Points& x) override { return inner_.prepare(x); }
  bool round_kinks(double share) override { return inner_.round_kinks(share); }
  bool has_circulatory_force() const override { return inner_.has_circulatory_force(); }
  void add_circulatory_force(const Points& x, Points& force) const override {
    inner_.add_circulatory_force(x, force);
  }
  void add_circulatory_tangent(const Points& x, std::vector<TangentBlock>& blocks) const override {
    inner_.add_circulatory_tangent(x, blocks);
  }
  bool rebuild_potential(const Points& x) override { return inner_.rebuild_potential(x); }
  bool simplify() override { return inner_.simplify(); }
  bool limits_steps() const override { return inner_.limits_steps(); }
  double step_limit(const Points& x, const Points& d, double most) const override {
    return inner_.step_limit(x, d, most);
  }
  bool escalate_stiffness(const Points& x) override { return inner_.escalate_stiffness(x); }
  bool restore_stiffness() override { return inner_.restore_stiffness(); }
  TermCounters counters() const override { return inner_.counters(); }

 private:
  std::shared_ptr<Objective> owner_;
  EnergyTerm& inner_;
  std::shared_ptr<const Points> rest_;
  Fault fault_;
  double reach_;
};

}  // namespace

std::string fault_name(Fault fault) {
  switch (fault) {
    case Fault::NaN:
      return "energy not a number";
    case Fault::Infinity:
      return "energy infinite";
    case Fault::NaNGradient:
      return "gradient not a number";
    case Fault::Throws:
      return "exception";
  }
  return "";
}

void make_faulty(Model& model, Fault fault, double reach) {
  const std::shared_ptr<Objective> owner = std::move(model.objective);
  std::shared_ptr<const Points> rest = std::make_shared<Points>(model.X);
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  for (const auto& inner : owner->terms()) {
    const bool fails = rest != nullptr && inner->role() == TermRole::Internal;
    terms.push_back(std::make_unique<PassingTerm>(owner, *inner, fails ? rest : nullptr, fault, reach));
    if (fails) rest = nullptr;
  }
  model.objective = std::make_unique<Objective>(model.X, owner->fixed(), std::move(terms));
}

}  // namespace coapt
