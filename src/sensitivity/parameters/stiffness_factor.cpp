#include "sensitivity/parameters/stiffness_factor.hpp"

#include "core/error.hpp"
#include "sensitivity/detail/elastic_kernels.hpp"

#include <cmath>
#include <numeric>

namespace coapt {
namespace {

// Multiplies the energy of one element.
void stiffen(CstStVK::Rest& rest, double factor, bool is_size) {
  rest.lambda *= factor;
  rest.mu *= factor;
  if (is_size) rest.volume *= factor;
}
void stiffen(CstTensionField::Rest& rest, double factor, bool is_size) {
  stiffen(rest.stvk, factor, is_size);
  rest.uniaxial *= factor;
}
void stiffen(BendingHinge::Rest& rest, double factor, bool) { rest.stiffness *= factor; }
void stiffen(Cable::Rest& rest, double factor, bool) { rest.stiffness *= factor; }
void stiffen(TetherCubic::Rest& rest, double factor, bool) { rest.strength *= factor; }
template <typename Rest>
requires requires(Rest rest) { rest.volume; }
void stiffen(Rest& rest, double factor, bool) { rest.volume *= factor; }
template <typename Rest>
requires requires(Rest rest) { rest.area; }
void stiffen(Rest& rest, double factor, bool) { rest.area *= factor; }

// Whether there is energy that no modulus multiplies.
bool has_more(const CstStVK::Rest& rest) { return rest.prestress != 0; }
bool has_more(const CstTensionField::Rest& rest) { return rest.stvk.prestress != 0; }
bool has_more(const Cable::Rest& rest) { return rest.tension != 0; }
template <typename Rest>
bool has_more(const Rest&) {
  return false;
}

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
      visit_element_term(ElasticKernels{}, *part.term, [&](auto& term) {
        auto rest = term.rest();
        for (size_t k = 0; k < part.elements.size(); ++k)
          stiffen(rest[static_cast<size_t>(part.elements[k])],
                  multiplier(part, k, value[0]) / multiplier(part, k, value_), part.is_size);
        term.set_rest(std::move(rest));
      });
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
      visit_elements(part, x, [&](const int* nodes, double slope, double, const auto& g) {
        for (int a = 0; a < g.size() / 3; ++a)
          sum += slope * g.template segment<3>(3 * a).dot(weights.col(nodes[a]));
      });
    return Vector::Constant(1, sum);
  }

  void push_forward(const Points& x, const Vector& change, Points& result) const override {
    for (const StiffnessPart& part : parts_)
      visit_elements(part, x, [&](const int* nodes, double slope, double, const auto& g) {
        for (int a = 0; a < g.size() / 3; ++a)
          result.col(nodes[a]) += change[0] * slope * g.template segment<3>(3 * a);
      });
  }

  Vector energy_derivative(const Points& x, const EnergyTerm& term) const override {
    double sum = 0;
    for (const StiffnessPart& part : parts_)
      if (part.term == &term)
        visit_elements(part, x,
                       [&](const int*, double slope, double energy, const auto&) { sum += slope * energy; });
    return Vector::Constant(1, sum);
  }

  Vector tension_derivative(const Points& x, const EnergyTerm& term, int element) const override {
    double sum = 0;
    for (const StiffnessPart& part : parts_) {
      if (part.term != &term || term.stencils().width != 2) continue;
      const int* first = term.stencils().nodes.data() + 2 * static_cast<size_t>(element);
      const Vec3 along = (x.col(first[1]) - x.col(first[0])).stableNormalized();
      visit_elements(part, x, [&](const int* nodes, double slope, double, const auto& g) {
        if (nodes == first) sum += slope * along.dot(g.template segment<3>(3));
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
    visit_element_term(ElasticKernels{}, *part.term, [&]<typename Kernel>(ElementTerm<Kernel>& term) {
      Eigen::Vector<double, 3 * Kernel::kNodes> g;
      for (size_t k = 0; k < part.elements.size(); ++k) {
        const auto e = static_cast<size_t>(part.elements[k]);
        const double energy = Kernel::evaluate(term.rest()[e], element_positions(term, e, x), &g, nullptr);
        const double slope = part.shares[k] * part.power * std::pow(value_ / first_, part.power - 1) /
                             (first_ * multiplier(part, k, value_));
        visit(term.stencils().nodes.data() + Kernel::kNodes * e, slope, energy, g);
      }
    });
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
  const bool is_elastic = visit_element_term(ElasticKernels{}, *part.term, [&](const auto& elements) {
    for (const int e : part.elements) {
      if (e < 0 || e >= elements.stencils().count())
        defects.push_back(term + "has no element " + std::to_string(e));
      else
        is_prestressed = is_prestressed || has_more(elements.rest()[static_cast<size_t>(e)]);
    }
  });
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
