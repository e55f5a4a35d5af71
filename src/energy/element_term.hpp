// A term made of one element law: gathers, calls the kernel, scatters. Written once for all laws.
#pragma once

#include "energy/moving_part.hpp"
#include "energy/pour_elements.hpp"
#include "energy/project_psd.hpp"
#include "energy/term.hpp"
#include "energy/term_access.hpp"

#include <algorithm>
#include <concepts>
#include <span>
#include <typeinfo>
#include <utility>

namespace coapt {

// The mathematics of ONE element: no mesh, no assembly, no state.
//   kNodes            number of nodes
//   kType, kRole      as in the scene file; internal, load or contact
//   Rest              plain data of one element, computed once from the reference state
//   evaluate          energy at x (node after node); derivatives only where asked (null = not wanted)
template <class K>
concept ElementKernel = requires(const typename K::Rest& rest, const Eigen::Vector<double, 3 * K::kNodes>& x,
                                 Eigen::Vector<double, 3 * K::kNodes>* g,
                                 Eigen::Matrix<double, 3 * K::kNodes, 3 * K::kNodes>* H) {
  { K::evaluate(rest, x, g, H) } -> std::same_as<double>;
  { K::kType } -> std::convertible_to<std::string_view>;
  { K::kRole } -> std::convertible_to<TermRole>;
};

// A kernel that knows a positive semidefinite Hessian in closed form:
//   evaluate_projected  as evaluate, all derivatives wanted, with that Hessian
// Without it the negative eigenvalues of the element's matrix are found numerically, which costs ten times
// the rest. A load whose indefinite part is to stay may give its exact Hessian here.
template <class K>
concept ProjectsItself = ElementKernel<K> &&
    requires(const typename K::Rest& rest, const Eigen::Vector<double, 3 * K::kNodes>& x,
             Eigen::Vector<double, 3 * K::kNodes>* g,
             Eigen::Matrix<double, 3 * K::kNodes, 3 * K::kNodes>* H) {
  { K::evaluate_projected(rest, x, g, H) } -> std::same_as<double>;
};

// A kernel whose law has a kink:
//   rounded  rest data of the same element with the kink rounded over at least a share of its length
template <class K>
concept HasKink = ElementKernel<K> && requires(const typename K::Rest& rest, double share) {
  { K::rounded(rest, share) } -> std::same_as<typename K::Rest>;
};

// A kernel whose law stiffens without bound, for EnergyTerm::limit_stress():
//   limit_stress   sets the limit in the rest data; an infinite scale takes it away
//   raise_limit    moves it at x, and returns the excess there
template <class K>
concept HasStressLimit = ElementKernel<K> &&
    requires(typename K::Rest& rest, const Eigen::Vector<double, 3 * K::kNodes>& x,
             const TensionScale& scale) {
  K::limit_stress(rest, scale);
  { K::raise_limit(rest, x) } -> std::same_as<double>;
};

// What a kernel may say beside, for parameters with derivatives, fields and other solvers: everything that
// TermAccess asks for. None of it is needed to solve a scene.
//   kKind                            energy/term_kind.hpp
//   stiffen(rest, factor, is_size)   multiplies its moduli
//   has_prestress(rest)              whether there is energy that these leave out
//   line(rest), axial(rest, l)       of a line: what it is, and its law at the distance l
//   lengthen(rest, length)           gives a line another rest length
//   slope_by_rest(rest, law, l)      derivatives of a line by that
//   reshaped(rest, from, to)         the element with other places of its nodes at rest
//   shape(rest)                      of a triangle: D_X^-1
//   relaxes(rest), state(rest, x)    of a membrane: whether it wrinkles, and how it carries its load
//   film_tension(rest), hinge_stiffness(rest), pressure(rest), set_pressure(rest, p)
template <class K>
concept IsStiff = requires(typename K::Rest& rest) {
  K::stiffen(rest, 1.0, true);
};
template <class K>
concept IsLine = requires(const typename K::Rest& rest) {
  { K::line(rest) } -> std::same_as<LineTraits>;
  { K::axial(rest, 1.0) } -> std::same_as<AxialLaw>;
};
template <class K>
concept HasRestLength = IsLine<K> && requires(typename K::Rest& rest, const AxialLaw& law) {
  K::lengthen(rest, 1.0);
  { K::slope_by_rest(rest, law, 1.0) } -> std::same_as<RestSlope>;
};
template <class K>
concept HasRestShape = (K::kKind == TermKind::Bending ||
                        requires(const typename K::Rest& rest) { K::shape(rest); }) &&
                       requires(const typename K::Rest& rest, const Corners& X) {
  { K::reshaped(rest, X, X) } -> std::same_as<typename K::Rest>;
};

template <ElementKernel K>
class ElementTerm final : public EnergyTerm, public TermAccess {
 public:
  static constexpr int kSize = 3 * K::kNodes;
  using ElementVector = Eigen::Vector<double, kSize>;
  using ElementMatrix = Eigen::Matrix<double, kSize, kSize>;

  // nodes: kNodes per element. Pre: nodes.size() == kNodes * rest.size().
  ElementTerm(std::string name, std::vector<int> nodes, std::vector<typename K::Rest> rest)
      : EnergyTerm(std::move(name)), stencils_{K::kNodes, std::move(nodes)}, rest_(std::move(rest)) {}

  std::string_view type() const override { return K::kType; }
  TermRole role() const override { return K::kRole; }
  const Stencils& stencils() const override { return stencils_; }
  const std::vector<typename K::Rest>& rest() const { return rest_; }

  // Other data of the same elements, as after a change of a parameter. Pre: as many as there were.
  void set_rest(std::vector<typename K::Rest> rest) {
    rest_ = std::move(rest);
    sharp_.clear();
  }

  bool round_kinks(double share) override {
    if constexpr (HasKink<K>) {
      if (sharp_.empty()) sharp_ = rest_;
      std::transform(sharp_.begin(), sharp_.end(), rest_.begin(), rest_.begin(),
                     [share](const typename K::Rest& sharp, const typename K::Rest& now) {
                       typename K::Rest rounded = K::rounded(sharp, share);
                       if constexpr (requires { rounded.limit; }) rounded.limit = now.limit;
                       return rounded;
                     });
    }
    return HasKink<K>;
  }

  bool limit_stress(const TensionScale& scale) override {
    if constexpr (HasStressLimit<K>)
      for (auto& rest : rest_) K::limit_stress(rest, scale);
    return HasStressLimit<K>;
  }

  double raise_stress_limits(const Points& x) override {
    double excess = 0;
    if constexpr (HasStressLimit<K>)
      for (size_t e = 0; e < rest_.size(); ++e)
        excess =
            std::max(excess, K::raise_limit(rest_[e], gather(x, stencils_.nodes.data() + e * K::kNodes)));
    return excess;
  }

  void release_stress_limits() override { limit_stress({kInfinity, kInfinity}); }

  std::unique_ptr<EnergyTerm> part(MovingPart& moving) const override {
    std::vector<int> nodes;
    std::vector<typename K::Rest> rest;
    for (size_t e = 0; e < rest_.size(); ++e) {
      const std::span<const int, K::kNodes> corners(stencils_.nodes.data() + e * K::kNodes, K::kNodes);
      if (!moving.moves_any(corners)) continue;
      for (const int node : corners) nodes.push_back(moving.number(node));
      rest.push_back(rest_[e]);
    }
    return std::make_unique<ElementTerm>(name(), std::move(nodes), std::move(rest));
  }

  TermKind kind() const override {
    if constexpr (requires { K::kKind; })
      return K::kKind;
    else
      return TermKind::Other;
  }

  bool has_elastic_elements() const override { return K::kRole == TermRole::Internal; }

  double evaluate_element(int element, const double* x, double* g, double* H) const override {
    return evaluate_at(rest_at(element), x, g, H);
  }

  std::function<double(const double* x, double* g)> element_energy(int element) const override {
    return [rest = rest_at(element)](const double* x, double* g) { return evaluate_at(rest, x, g, nullptr); };
  }

  bool take_elements(const EnergyTerm& from) override {
    if (typeid(from) != typeid(*this)) return false;
    set_rest(static_cast<const ElementTerm&>(from).rest_);
    return true;
  }

  bool has_stiffness() const override { return IsStiff<K>; }
  void multiply_stiffness(int element, double factor, bool is_size) override {
    if constexpr (IsStiff<K>) K::stiffen(changed(element), factor, is_size);
  }
  bool has_prestress(int element) const override {
    if constexpr (requires { K::has_prestress(rest_[0]); })
      return K::has_prestress(rest_at(element));
    else
      return false;
  }

  bool has_lines() const override { return IsLine<K>; }
  LineTraits line(int element) const override {
    if constexpr (IsLine<K>)
      return K::line(rest_at(element));
    else
      return {};
  }
  std::function<AxialLaw(double distance)> line_law(int element) const override {
    if constexpr (IsLine<K>)
      return [rest = rest_at(element)](double l) { return K::axial(rest, l); };
    else
      return {};
  }
  bool has_rest_lengths() const override { return HasRestLength<K>; }
  void set_rest_length(int element, double length) override {
    if constexpr (HasRestLength<K>) K::lengthen(changed(element), length);
  }
  RestSlope slope_by_rest(int element, const AxialLaw& law, double l) const override {
    if constexpr (HasRestLength<K>)
      return K::slope_by_rest(rest_at(element), law, l);
    else
      return {};
  }

  bool has_rest_shape() const override { return HasRestShape<K>; }
  const Eigen::Matrix2d* rest_frame(int element) const override {
    if constexpr (requires { K::shape(rest_[0]); })
      return &K::shape(rest_at(element));
    else
      return nullptr;
  }
  void reshape(int element, const Corners& from, const Corners& to) override {
    if constexpr (HasRestShape<K>) changed(element) = K::reshaped(rest_at(element), from, to);
  }

  std::optional<MembraneRegime> regime(int element, const double* x) const override {
    if constexpr (requires { K::relaxes(rest_[0]); })
      if (K::relaxes(rest_at(element)))
        return K::state(rest_at(element), Eigen::Map<const ElementVector>(x)).regime;
    return std::nullopt;
  }
  double film_tension(int element) const override {
    if constexpr (requires { K::film_tension(rest_[0]); })
      return K::film_tension(rest_at(element));
    else
      return 0;
  }
  double hinge_stiffness(int element) const override {
    if constexpr (requires { K::hinge_stiffness(rest_[0]); })
      return K::hinge_stiffness(rest_at(element));
    else
      return 0;
  }
  std::optional<double> pressure() const override {
    if constexpr (requires { K::pressure(rest_[0]); })
      if (!rest_.empty()) return K::pressure(rest_.front());
    return std::nullopt;
  }
  void set_pressure(double p) override {
    if constexpr (requires { K::set_pressure(rest_[0], p); })
      for (auto& rest : rest_) K::set_pressure(rest, p);
  }

  double evaluate(const Points& x, Sink& sink) const override {
    if (sink.wants_hessian()) return evaluate_with_hessian(x, sink);
    double energy = 0;
    ElementVector g;
    ElementVector* wanted = sink.wants_gradient() ? &g : nullptr;
    const int* nodes = stencils_.nodes.data();
    for (size_t e = 0; e < rest_.size(); ++e, nodes += K::kNodes) {
      energy += K::evaluate(rest_[e], gather(x, nodes), wanted, nullptr);
      if (wanted != nullptr) scatter(g, nodes, sink);
    }
    return energy;
  }

 private:
  const typename K::Rest& rest_at(int element) const { return rest_[static_cast<size_t>(element)]; }
  // To be changed: what it was before its kinks were rounded is of no use then.
  typename K::Rest& changed(int element) {
    sharp_.clear();
    return rest_[static_cast<size_t>(element)];
  }

  static double evaluate_at(const typename K::Rest& rest, const double* x, double* g, double* H) {
    const ElementVector local = Eigen::Map<const ElementVector>(x);
    ElementVector gradient;
    ElementMatrix hessian;
    const double energy =
        K::evaluate(rest, local, g == nullptr ? nullptr : &gradient, H == nullptr ? nullptr : &hessian);
    if (g != nullptr) std::copy(gradient.data(), gradient.data() + kSize, g);
    if (H != nullptr) std::copy(hessian.data(), hessian.data() + kSize * kSize, H);
    return energy;
  }

  static ElementVector gather(const Points& x, const int* nodes) {
    ElementVector local;
    for (int a = 0; a < K::kNodes; ++a) local.template segment<3>(3 * a) = x.col(nodes[a]);
    return local;
  }

  static void scatter(const ElementVector& g, const int* nodes, Sink& sink) {
    for (int a = 0; a < K::kNodes; ++a) sink.add_gradient(nodes[a], g.template segment<3>(3 * a));
  }

  static double evaluate_projected(const typename K::Rest& rest, const ElementVector& x, ElementVector& g,
                                   ElementMatrix& h) {
    if constexpr (ProjectsItself<K>) {
      return K::evaluate_projected(rest, x, &g, &h);
    } else {
      const double energy = K::evaluate(rest, x, &g, &h);
      project_psd(h);
      return energy;
    }
  }

  // Derivatives of one element, between its evaluation and its scatter.
  struct Evaluated {
    ElementVector g;
    ElementMatrix h;
  };

  double evaluate_element(const Points& x, size_t e, Projection projection, Evaluated& out) const {
    const ElementVector local = gather(x, stencils_.nodes.data() + e * K::kNodes);
    return projection == Projection::PositiveSemidefinite ? evaluate_projected(rest_[e], local, out.g, out.h)
                                                          : K::evaluate(rest_[e], local, &out.g, &out.h);
  }

  void scatter_element(size_t e, const Evaluated& in, Sink& sink) const {
    scatter(in.g, stencils_.nodes.data() + e * K::kNodes, sink);
    const long offset = static_cast<long>(e) * K::kNodes * K::kNodes;
    for (int a = 0; a < K::kNodes; ++a)
      for (int b = 0; b < K::kNodes; ++b)
        sink.add_block(offset, K::kNodes, a, b, in.h.template block<3, 3>(3 * a, 3 * b));
  }

  double evaluate_with_hessian(const Points& x, Sink& sink) const {
    return pour_elements<Evaluated>(
        stencils_, sink,
        [&](size_t e, Evaluated& out) { return evaluate_element(x, e, sink.projection(), out); },
        [&](size_t e, const Evaluated& in, Sink& to) { scatter_element(e, in, to); });
  }

  Stencils stencils_;
  std::vector<typename K::Rest> rest_;
  std::vector<typename K::Rest> sharp_;  // as it was given, once kinks have been rounded
};

}  // namespace coapt
