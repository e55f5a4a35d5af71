#include "sensitivity/parameters/stiffness_factor.hpp"

#include "core/error.hpp"
#include "energy/term_access.hpp"
#include "sensitivity/detail/element_positions.hpp"

#include <cmath>
#include <numeric>

namespace coapt {
namespace {

class StiffnessFactor final : public Parameter {
 public:
  StiffnessFactor(std::string name, std::vector<StiffnessPart> parts, double value)
      : Parameter(std::move(name)), parts_(std::move(parts)), first_(value), value_(value) {}

  Vector value() const override { return Vector::Constant(1, value_); }

  std::string defect(const Vector& value) const override {
    if (value[0] > 0 && std::isfinite(value[0])) return {};
    return "parameter \"" + name() + "\": must be positive and finite";
  }

  void set(const Vector& value) override {
    for (const StiffnessPart& part : parts_)
      for (size_t k = 0; k < part.elements.size(); ++k)
        access_of(*part.term)
            ->multiply_stiffness(part.elements[k],
                                 multiplier(part, k, value[0]) / multiplier(part, k, value_), part.is_size);
    value_ = value[0];
  }

  std::vector<WrittenDatum> written() const override {
    std::vector<WrittenDatum> data;
    for (const StiffnessPart& part : parts_)
      for (const int e : part.elements) data.push_back({WrittenDatum::Kind::Stiffness, part.term, e});
    return data;
  }

  Vector pull_back(const Points& x, const Points& weights) const override {
    double sum = 0;
    for (const StiffnessPart& part : parts_)
      visit_elements(part, x, [&](const int* nodes, double slope, double, const ElementVector& g) {
        for (int a = 0; a < g.size() / 3; ++a) sum += slope * g.segment<3>(3 * a).dot(weights.col(nodes[a]));
      });
    return Vector::Constant(1, sum);
  }

  void push_forward(const Points& x, const Vector& change, Points& result) const override {
    for (const StiffnessPart& part : parts_)
      visit_elements(part, x, [&](const int* nodes, double slope, double, const ElementVector& g) {
        for (int a = 0; a < g.size() / 3; ++a)
          result.col(nodes[a]) += change[0] * slope * g.segment<3>(3 * a);
      });
  }

  Vector energy_derivative(const Points& x, const EnergyTerm& term) const override {
    double sum = 0;
    for (const StiffnessPart& part : parts_)
      if (part.term == &term)
        visit_elements(part, x, [&](const int*, double slope, double energy, const ElementVector&) {
          sum += slope * energy;
        });
    return Vector::Constant(1, sum);
  }

  Vector tension_derivative(const Points& x, const EnergyTerm& term, int element) const override {
    double sum = 0;
    for (const StiffnessPart& part : parts_) {
      if (part.term != &term || !access_of(*part.term)->has_lines()) continue;
      const int* first = term.stencils().nodes.data() + 2 * static_cast<size_t>(element);
      const Vec3 along = (x.col(first[1]) - x.col(first[0])).stableNormalized();
      visit_elements(part, x, [&](const int* nodes, double slope, double, const ElementVector& g) {
        if (nodes == first) sum += slope * along.dot(g.segment<3>(3));
      });
    }
    return Vector::Constant(1, sum);
  }

 private:
  double multiplier(const StiffnessPart& part, size_t k, double value) const {
    return 1 - part.shares[k] + part.shares[k] * std::pow(value / first_, part.power);
  }

  // visit(nodes, logarithmic derivative of the energy by the number, energy, gradient) of each element.
  template <typename Visit>
  void visit_elements(const StiffnessPart& part, const Points& x, const Visit& visit) const {
    const TermAccess& access = *access_of(*part.term);
    const Stencils& stencils = part.term->stencils();
    ElementVector g(3 * stencils.width);
    for (size_t k = 0; k < part.elements.size(); ++k) {
      const int e = part.elements[k];
      const double energy =
          access.evaluate_element(e, element_positions(*part.term, e, x).data(), g.data(), nullptr);
      const double slope = part.shares[k] * part.power * std::pow(value_ / first_, part.power - 1) /
                           (first_ * multiplier(part, k, value_));
      visit(stencils.nodes.data() + stencils.width * static_cast<size_t>(e), slope, energy, g);
    }
  }

  std::vector<StiffnessPart> parts_;
  double first_, value_;
};

void complete(StiffnessPart& part) {
  if (part.elements.empty()) {
    part.elements.resize(static_cast<size_t>(part.term->stencils().count()));
    std::iota(part.elements.begin(), part.elements.end(), 0);
  }
  if (part.shares.empty()) part.shares.assign(part.elements.size(), 1);
}

void find_defects(const StiffnessPart& part, const std::string& where, std::vector<std::string>& defects) {
  const std::string term = where + "term \"" + part.term->name() + "\" ";
  if (part.shares.size() != part.elements.size())
    defects.push_back(term + "has " + std::to_string(part.shares.size()) + " shares for " +
                      std::to_string(part.elements.size()) + " elements");
  for (const double share : part.shares)
    if (!(share > 0 && share <= 1))
      defects.push_back(term + "has a share of " + std::to_string(share) + "; it must be above 0, at most 1");
  bool is_prestressed = false;
  const TermAccess* access = access_of(*part.term);
  const bool is_elastic = access != nullptr && access->has_stiffness();
  if (is_elastic)
    for (const int e : part.elements) {
      if (e < 0 || e >= part.term->stencils().count())
        defects.push_back(term + "has no element " + std::to_string(e));
      else
        is_prestressed = is_prestressed || access->has_prestress(e);
    }
  if (!is_elastic)
    defects.push_back(term + "(" + std::string(part.term->type()) + ") has no stiffness that goes with it");
  if (is_prestressed)
    defects.push_back(term + "has a prestress or a constant tension, which the number does not multiply");
}

}  // namespace

std::unique_ptr<Parameter> make_stiffness_factor(std::string name, std::vector<StiffnessPart> parts,
                                                 double value) {
  const std::string where = "parameter \"" + name + "\": ";
  std::vector<std::string> defects;
  if (!(value > 0 && std::isfinite(value))) defects.push_back(where + "must be positive and finite");
  for (StiffnessPart& part : parts) {
    complete(part);
    find_defects(part, where, defects);
  }
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<StiffnessFactor>(std::move(name), std::move(parts), value);
}

}  // namespace coapt
