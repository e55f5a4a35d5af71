#include "tuning/detail/scene_derivatives.hpp"

#include <utility>

namespace coapt {
namespace {

// The nodal gradient of all terms, loads without a potential included.
Points nodal_gradient(const Scene& scene, const SceneGeometry& geometry, const Points& x) {
  Points gradient = Points::Zero(3, x.cols()), circulatory = gradient;
  for (const auto& term : build_terms(scene, geometry)) {
    Sink sink(gradient.data());
    term->prepare(x);
    term->evaluate(x, sink);
    term->add_circulatory_force(x, circulatory);
  }
  return gradient - circulatory;
}

}  // namespace

SceneDerivatives::SceneDerivatives(const SceneGeometry& geometry, std::vector<Neighbours> neighbours,
                                   double share)
    : Parameter("scene"), geometry_(geometry), neighbours_(std::move(neighbours)), share_(share) {}

std::string SceneDerivatives::defect(const Vector& given) const {
  return given == value() ? std::string() : "parameter \"" + name() + "\": has derivatives only, and stays";
}

Points SceneDerivatives::force_derivative(const Neighbours& of, const Points& x) const {
  return (nodal_gradient(of.larger, geometry_, x) - nodal_gradient(of.smaller, geometry_, x)) / (2 * share_);
}

Vector SceneDerivatives::pull_back(const Points& x, const Points& weights) const {
  Vector result = value();
  for (size_t k = 0; k < neighbours_.size(); ++k)
    result[static_cast<Eigen::Index>(k)] = force_derivative(neighbours_[k], x).cwiseProduct(weights).sum();
  return result;
}

void SceneDerivatives::push_forward(const Points& x, const Vector& change, Points& g) const {
  for (size_t k = 0; k < neighbours_.size(); ++k)
    if (const double own = change[static_cast<Eigen::Index>(k)]; own != 0)
      g += own * force_derivative(neighbours_[k], x);
}

}  // namespace coapt
