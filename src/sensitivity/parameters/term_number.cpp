#include "sensitivity/parameters/term_number.hpp"

#include "core/error.hpp"
#include "energy/term_access.hpp"
#include "sensitivity/parameters/line_access.hpp"

#include <array>
#include <cmath>

namespace coapt {
namespace {

using Terms = std::vector<std::unique_ptr<EnergyTerm>>;

constexpr double kDifference = 1e-3;  // of the scale

// First derivative from five values, at these multiples of a step and with these weights over it.
struct Stencil {
  std::array<double, 5> offsets, weights;
};
constexpr Stencil kCentral = {{-2, -1, 0, 1, 2}, {1. / 12, -8. / 12, 0, 8. / 12, -1. / 12}};
constexpr Stencil kForward = {{0, 1, 2, 3, 4}, {-25. / 12, 4, -3, 4. / 3, -1. / 4}};
constexpr Stencil kBackward = {{0, -1, -2, -3, -4}, {25. / 12, -4, 3, -4. / 3, 1. / 4}};

// Whatever became of rest lengths since the scene was read stays.
void carry_lengths(EnergyTerm& from, EnergyTerm& to) {
  const std::unique_ptr<LineAccess> old_lines = line_access(from), lines = line_access(to);
  if (old_lines == nullptr) return;
  Vector lengths(from.stencils().count());
  for (int e = 0; e < lengths.size(); ++e) lengths[e] = old_lines->rest_length(e);
  if ((lengths.array() > 0).all()) lines->set_rest_lengths(lengths);
}

class FiniteDifferenceParameter final : public Parameter {
 public:
  FiniteDifferenceParameter(std::string name, TermNumber number)
      : Parameter(std::move(name)), number_(std::move(number)), value_(number_.value) {}

  Vector value() const override { return Vector::Constant(1, value_); }

  std::string defect(const Vector& value) const override {
    const std::string wrong =
        std::isfinite(value[0]) ? number_.defect(value[0]) : std::string("is not finite");
    return wrong.empty() ? wrong : "parameter \"" + name() + "\": " + wrong;
  }

  void set(const Vector& value) override {
    const Terms made = made_at(value[0]);
    for (size_t k = 0; k < made.size(); ++k) access_of(*number_.terms[k])->take_elements(*made[k]);
    value_ = value[0];
    if (number_.keep) number_.keep(value_);
  }

  std::vector<WrittenDatum> written() const override {
    const auto kind = number_.keep ? WrittenDatum::Kind::Remade : WrittenDatum::Kind::Made;
    std::vector<WrittenDatum> data;
    for (const EnergyTerm* term : number_.terms) {
      const std::vector<WrittenDatum> own = whole_term(kind, *term);
      data.insert(data.end(), own.begin(), own.end());
    }
    return data;
  }

  Vector pull_back(const Points& x, const Points& weights) const override {
    return Vector::Constant(1, force_derivative(x).cwiseProduct(weights).sum());
  }

  void push_forward(const Points& x, const Vector& change, Points& result) const override {
    result += change[0] * force_derivative(x);
  }

  Vector energy_derivative(const Points& x, const EnergyTerm& term) const override {
    double sum = 0;
    visit_neighbours([&](double weight, EnergyTerm& made, const EnergyTerm& own) {
      Sink sink;
      if (&own == &term) sum += weight * made.evaluate(x, sink);
    });
    return Vector::Constant(1, sum);
  }

  Vector tension_derivative(const Points& x, const EnergyTerm& term, int element) const override {
    double sum = 0;
    visit_neighbours([&](double weight, EnergyTerm& made, const EnergyTerm& own) {
      if (&own == &term)
        sum += weight * line_access(made)->at(element, line_length(made, element, x)).law.force;
    });
    return Vector::Constant(1, sum);
  }

 private:
  Terms made_at(double value) const {
    Terms made = number_.terms_at(value);
    for (size_t k = 0; k < made.size(); ++k) carry_lengths(*number_.terms[k], *made[k]);
    return made;
  }

  bool is_admissible(const Stencil& stencil) const {
    const double step = kDifference * number_.scale;
    return number_.defect(value_ + stencil.offsets.front() * step).empty() &&
           number_.defect(value_ + stencil.offsets.back() * step).empty();
  }

  const Stencil& stencil() const {
    for (const Stencil* each : {&kCentral, &kForward, &kBackward})
      if (is_admissible(*each)) return *each;
    throw InputError("parameter \"" + name() + "\": has no room to either side for a derivative");
  }

  // visit(weight, made, own) for the terms at each value of the stencil.
  template <typename Visit>
  void visit_neighbours(const Visit& visit) const {
    const Stencil& points = stencil();
    const double step = kDifference * number_.scale;
    for (size_t i = 0; i < points.offsets.size(); ++i) {
      if (points.weights[i] == 0) continue;
      const Terms made = made_at(value_ + points.offsets[i] * step);
      for (size_t k = 0; k < made.size(); ++k) visit(points.weights[i] / step, *made[k], *number_.terms[k]);
    }
  }

  // Metrics ask for it at one shape again and again. That the terms' own forces are the same tells that
  // nothing else has changed them since.
  const Points& force_derivative(const Points& x) const {
    Points own = Points::Zero(3, x.cols()), g = own;
    Sink own_sink(own.data());
    for (const EnergyTerm* term : number_.terms) term->evaluate(x, own_sink);
    if (x_.cols() == x.cols() && x_ == x && own_ == own) return derivative_;
    x_ = x;
    own_ = own;
    derivative_.setZero(3, x.cols());
    visit_neighbours([&](double weight, EnergyTerm& made, const EnergyTerm&) {
      g.setZero();
      Sink sink(g.data());
      made.evaluate(x, sink);
      derivative_ += weight * g;
    });
    return derivative_;
  }

  TermNumber number_;
  double value_;
  mutable Points x_, own_, derivative_;  // of the last call
};

}  // namespace

std::unique_ptr<Parameter> make_term_number(std::string name, TermNumber number) {
  const std::string where = "parameter \"" + name + "\": ";
  std::vector<std::string> defects;
  if (!(number.scale > 0 && std::isfinite(number.scale)))
    defects.push_back(where + "its scale must be positive");
  for (EnergyTerm* term : number.terms)
    if (const TermAccess* access = access_of(*term); access == nullptr || !access->has_elastic_elements())
      defects.push_back(where + "term \"" + term->name() + "\" (" + std::string(term->type()) +
                        ") is not one of elastic elements");
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<FiniteDifferenceParameter>(std::move(name), std::move(number));
}

}  // namespace coapt
