#include "sensitivity/metrics/metrics_state.hpp"

#include "core/error.hpp"
#include "sensitivity/parameters/line_access.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

class StrainEnergy final : public Metric {
 public:
  StrainEnergy(std::string name, const Objective& objective)
      : Metric(std::move(name)), objective_(objective) {}

  double evaluate(const Points& x, Points* gradient) const override {
    if (gradient != nullptr) gradient->setZero(3, x.cols());
    Sink sink = gradient == nullptr ? Sink() : Sink(gradient->data());
    double energy = 0;
    for (const auto& term : objective_.terms())
      if (term->role() == TermRole::Internal) energy += term->evaluate(x, sink);
    return energy;
  }

  Vector partial(const Parameter& parameter, const Points& x) const override {
    Vector sum = Vector::Zero(parameter.value().size());
    for (const auto& term : objective_.terms())
      if (term->role() == TermRole::Internal) sum += parameter.energy_derivative(x, *term);
    return sum;
  }

 private:
  const Objective& objective_;
};

// (mean of F^p)^(1/p); of one line its force.
class LineForces final : public Metric {
 public:
  LineForces(std::string name, EnergyTerm& term, std::unique_ptr<LineAccess> lines, std::vector<int> elements,
             double exponent)
      : Metric(std::move(name)),
        term_(term),
        lines_(std::move(lines)),
        elements_(std::move(elements)),
        exponent_(exponent) {}

  double evaluate(const Points& x, Points* gradient) const override {
    if (gradient != nullptr) gradient->setZero(3, x.cols());
    const double value = norm(x);
    if (gradient == nullptr) return value;
    for (const int e : elements_) {
      const LineState line = at(e, x);
      const int* ends = &term_.stencils().nodes[2 * static_cast<size_t>(e)];
      const Vec3 pull = weight(line.law.force, value) * line.law.stiffness *
                        (x.col(ends[1]) - x.col(ends[0])).stableNormalized();
      gradient->col(ends[1]) += pull;
      gradient->col(ends[0]) -= pull;
    }
    return value;
  }

  Vector partial(const Parameter& parameter, const Points& x) const override {
    Vector sum = Vector::Zero(parameter.value().size());
    const double value = norm(x);
    for (const int e : elements_) {
      const double share = weight(at(e, x).law.force, value);
      if (share != 0) sum += share * parameter.tension_derivative(x, term_, e);
    }
    return sum;
  }

 private:
  LineState at(int e, const Points& x) const { return lines_->at(e, line_length(term_, e, x)); }

  double norm(const Points& x) const {
    double largest = 0;
    for (const int e : elements_) largest = std::max(largest, std::abs(at(e, x).law.force));
    if (exponent_ == 1 || largest == 0) return exponent_ == 1 ? at(elements_[0], x).law.force : 0;
    double sum = 0;
    for (const int e : elements_) sum += std::pow(std::abs(at(e, x).law.force) / largest, exponent_);
    return largest * std::pow(sum / static_cast<double>(elements_.size()), 1 / exponent_);
  }

  // Derivative of the norm by one force.
  double weight(double force, double value) const {
    if (exponent_ == 1) return 1;
    if (value == 0) return 0;
    return std::copysign(std::pow(std::abs(force) / value, exponent_ - 1), force) /
           static_cast<double>(elements_.size());
  }

  EnergyTerm& term_;
  std::unique_ptr<LineAccess> lines_;
  std::vector<int> elements_;
  double exponent_;
};

std::unique_ptr<Metric> line_forces(std::string name, EnergyTerm& term, std::vector<int> elements,
                                    double exponent) {
  const std::string where = "metric \"" + name + "\": ";
  std::unique_ptr<LineAccess> lines = line_access(term);
  std::vector<std::string> defects;
  if (lines == nullptr)
    defects.push_back(where + "term \"" + term.name() + "\" (" + std::string(term.type()) +
                      ") is not one of cables or tethers");
  if (elements.empty()) defects.push_back(where + "names no line");
  for (const int e : elements)
    if (e < 0 || e >= term.stencils().count())
      defects.push_back(where + "there is no line " + std::to_string(e) + "; the term has " +
                        std::to_string(term.stencils().count()));
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<LineForces>(std::move(name), term, std::move(lines), std::move(elements), exponent);
}

class NodePosition final : public Metric {
 public:
  NodePosition(std::string name, std::vector<int> nodes, Points weights)
      : Metric(std::move(name)), nodes_(std::move(nodes)), weights_(std::move(weights)) {}

  double evaluate(const Points& x, Points* gradient) const override {
    if (gradient != nullptr) gradient->setZero(3, x.cols());
    double sum = 0;
    for (size_t k = 0; k < nodes_.size(); ++k) {
      const Vec3 weight = weights_.col(static_cast<Eigen::Index>(k));
      sum += weight.dot(x.col(nodes_[k]));
      if (gradient != nullptr) gradient->col(nodes_[k]) += weight;
    }
    return sum;
  }

 private:
  std::vector<int> nodes_;
  Points weights_;
};

}  // namespace

std::unique_ptr<Metric> make_strain_energy(std::string name, const Objective& objective) {
  return std::make_unique<StrainEnergy>(std::move(name), objective);
}

std::unique_ptr<Metric> make_line_force(std::string name, EnergyTerm& term, int element) {
  return line_forces(std::move(name), term, {element}, 1);
}

std::unique_ptr<Metric> make_line_force_norm(std::string name, EnergyTerm& term, std::vector<int> elements,
                                             double exponent) {
  if (!(exponent >= 2 && std::isfinite(exponent)))
    throw InputError("metric \"" + name + "\": the exponent must be at least 2");
  return line_forces(std::move(name), term, std::move(elements), exponent);
}

std::unique_ptr<Metric> make_node_position(std::string name, std::vector<int> nodes, Points weights) {
  if (static_cast<Eigen::Index>(nodes.size()) != weights.cols())
    throw InputError("metric \"" + name + "\": needs a weight for each of the " +
                     std::to_string(nodes.size()) + " nodes, not " + std::to_string(weights.cols()));
  return std::make_unique<NodePosition>(std::move(name), std::move(nodes), std::move(weights));
}

}  // namespace coapt
