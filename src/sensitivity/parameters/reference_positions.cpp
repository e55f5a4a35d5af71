#include "sensitivity/parameters/reference_positions.hpp"

#include "core/error.hpp"
#include "energy/term_access.hpp"
#include "sensitivity/detail/element_positions.hpp"
#include "sensitivity/detail/rest_hinge.hpp"
#include "sensitivity/detail/rest_triangle.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

class ReferencePositions final : public Parameter {
 public:
  ReferencePositions(std::string name, std::vector<EnergyTerm*> terms, Points X, std::vector<int> nodes)
      : Parameter(std::move(name)),
        terms_(std::move(terms)),
        X_(std::move(X)),
        nodes_(std::move(nodes)),
        number_(static_cast<size_t>(X_.cols()), -1) {
    for (size_t k = 0; k < nodes_.size(); ++k)
      number_[static_cast<size_t>(nodes_[k])] = 3 * static_cast<int>(k);
    for (EnergyTerm* term : terms_) {
      access_.push_back(access_of(*term));
      std::vector<int>& touched = touched_.emplace_back();
      const Stencils& stencils = term->stencils();
      for (int e = 0; e < stencils.count(); ++e) {
        const int* first = nodes_of(*term, e);
        if (std::any_of(first, first + stencils.width, [&](int node) { return numbers(node) >= 0; }))
          touched.push_back(e);
      }
    }
  }

  Vector value() const override { return X_(Eigen::all, nodes_).reshaped(); }

  std::string defect(const Vector& value) const override {
    const Points X = placed(value);
    if (!X.allFinite()) return "parameter \"" + name() + "\": every number must be finite";
    for (EnergyTerm* term : terms_)
      for (int e = 0; e < term->stencils().count(); ++e) {
        const int* n = nodes_of(*term, e);
        const Vec3 a = X.col(n[1]) - X.col(n[0]);
        for (int k = 2; k < term->stencils().width; ++k)
          if (const Vec3 b = X.col(n[k]) - X.col(n[0]);
              !(a.cross(b).norm() > 1e-12 * std::max(a.squaredNorm(), b.squaredNorm())))
            return "parameter \"" + name() + "\": element " + std::to_string(e) + " of term \"" +
                   term->name() + "\" would have no area at rest";
      }
    return {};
  }

  void set(const Vector& value) override {
    const Points X = placed(value);
    for (size_t k = 0; k < terms_.size(); ++k)
      for (const int e : touched_[k])
        access_[k]->reshape(e, corners(*terms_[k], e, X_), corners(*terms_[k], e, X));
    X_ = X;
  }

  // Of whole elements: one that shares a node with those of another parameter knows nothing of its changes.
  std::vector<WrittenDatum> written() const override {
    std::vector<WrittenDatum> data;
    for (size_t k = 0; k < terms_.size(); ++k)
      for (const int e : touched_[k]) data.push_back({WrittenDatum::Kind::Shape, terms_[k], e});
    return data;
  }

  Vector pull_back(const Points& x, const Points& weights) const override {
    Vector result = none();
    visit(x, [&](const EnergyTerm& term, int e, const auto& rest) {
      add(term, e, rest.pulled_back(element_positions(term, e, weights)), result);
    });
    return result;
  }

  void push_forward(const Points& x, const Vector& change, Points& g) const override {
    Points motion = Points::Zero(3, X_.cols());
    for (size_t k = 0; k < nodes_.size(); ++k)
      motion.col(nodes_[k]) += change.segment<3>(3 * static_cast<Eigen::Index>(k));
    visit(x, [&](const EnergyTerm& term, int e, const auto& rest) {
      const auto slope = rest.pushed_forward(element_positions(term, e, motion));
      for (int a = 0; a < slope.size() / 3; ++a)
        g.col(nodes_of(term, e)[a]) += slope.template segment<3>(3 * a);
    });
  }

  Vector energy_derivative(const Points& x, const EnergyTerm& wanted) const override {
    Vector result = none();
    visit(
        x,
        [&](const EnergyTerm& term, int e, const auto& rest) { add(term, e, rest.energy_slope(), result); },
        &wanted);
    return result;
  }

 private:
  int numbers(int node) const { return number_[static_cast<size_t>(node)]; }  // first of a node; -1: none

  Points placed(const Vector& value) const {
    Points X = X_;
    for (size_t k = 0; k < nodes_.size(); ++k)
      X.col(nodes_[k]) = value.segment<3>(3 * static_cast<Eigen::Index>(k));
    return X;
  }

  static const int* nodes_of(const EnergyTerm& term, int e) {
    return &term.stencils().nodes[static_cast<size_t>(e) * static_cast<size_t>(term.stencils().width)];
  }

  static Corners corners(const EnergyTerm& term, int e, const Points& X) {
    Corners corners{};
    for (int a = 0; a < term.stencils().width; ++a)
      corners[static_cast<size_t>(a)] = X.col(nodes_of(term, e)[a]);
    return corners;
  }

  template <typename Slope>
  void add(const EnergyTerm& term, int e, const Slope& slope, Vector& result) const {
    for (int a = 0; a < term.stencils().width; ++a)
      if (const int first = numbers(nodes_of(term, e)[a]); first >= 0)
        result.segment<3>(first) += slope.template segment<3>(3 * a);
  }

  // visit_element(term, element, its derivatives) of every triangle and hinge that has one of the nodes; of
  // one term alone where it is given.
  template <typename Visit>
  void visit(const Points& x, const Visit& visit_element, const EnergyTerm* only = nullptr) const {
    for (size_t k = 0; k < terms_.size(); ++k) {
      if (only != nullptr && terms_[k] != only) continue;
      for (const int e : touched_[k]) {
        const Corners X = corners(*terms_[k], e, X_);
        const ElementVector at = element_positions(*terms_[k], e, x);
        if (access_[k]->rest_frame(e) != nullptr)
          visit_element(*terms_[k], e, RestTriangle::at(*access_[k], e, X, at.data()));
        else
          visit_element(*terms_[k], e, RestHinge::at(*access_[k], e, X, at.data()));
      }
    }
  }

  std::vector<EnergyTerm*> terms_;
  std::vector<TermAccess*> access_;  // to each of them
  Points X_;
  std::vector<int> nodes_;
  std::vector<int> number_;                // per node
  std::vector<std::vector<int>> touched_;  // elements of each term that have one of the nodes
};

// Whether X is the shape at rest that the term was built from.
bool is_shape_of(const EnergyTerm& term, const TermAccess& access, const Points& X) {
  for (int e = 0; e < term.stencils().count(); ++e) {
    const Eigen::Matrix2d* frame = access.rest_frame(e);
    if (frame == nullptr) continue;
    const int* n = &term.stencils().nodes[3 * static_cast<size_t>(e)];
    if (!has_shape(*frame, {X.col(n[0]), X.col(n[1]), X.col(n[2])})) return false;
  }
  return true;
}

}  // namespace

std::unique_ptr<Parameter> make_reference_positions(std::string name, const Objective& objective, Points X,
                                                    std::vector<int> nodes) {
  const std::string where = "parameter \"" + name + "\": ";
  std::vector<std::string> defects;
  for (const int node : nodes)
    if (node < 0 || node >= objective.node_count())
      defects.push_back(where + "there is no node " + std::to_string(node));
  if (X.cols() != objective.node_count())
    throw InputError(where + "the rest shape has " + std::to_string(X.cols()) + " nodes, the objective " +
                     std::to_string(objective.node_count()));
  std::vector<EnergyTerm*> terms;
  for (const auto& term : objective.terms()) {
    if (kind_of(*term) == TermKind::Spring)
      defects.push_back(
          where + "term \"" + term->name() + "\" (" + std::string(term->type()) +
          ") has springs that know nothing of the triangles at rest that they stand for; a rest "
          "shape can change under membranes of constant-strain triangles (cst_...) and bending");
    const TermAccess* access = access_of(*term);
    if (access == nullptr || !access->has_rest_shape()) continue;
    terms.push_back(term.get());
    if (!is_shape_of(*term, *access, X))
      defects.push_back(where + "the given rest shape is not that of term \"" + term->name() + "\"");
  }
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<ReferencePositions>(std::move(name), std::move(terms), std::move(X),
                                              std::move(nodes));
}

}  // namespace coapt
