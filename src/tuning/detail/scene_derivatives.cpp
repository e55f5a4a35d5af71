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

SceneDerivatives::SceneDerivatives(std::string name, const SceneGeometry& geometry, Neighbours neighbours,
                                   double share)
    : Parameter(std::move(name)), geometry_(geometry), neighbours_(std::move(neighbours)), share_(share) {}

std::string SceneDerivatives::defect(const Vector& given) const {
  return given == value() ? std::string() : "parameter \"" + name() + "\": has derivatives only, and stays";
}

Points SceneDerivatives::force_derivative(const Points& x) const {
  return (nodal_gradient(neighbours_.larger, geometry_, x) -
          nodal_gradient(neighbours_.smaller, geometry_, x)) /
         (2 * share_);
}

Vector SceneDerivatives::pull_back(const Points& x, const Points& weights) const {
  return Vector::Constant(1, force_derivative(x).cwiseProduct(weights).sum());
}

void SceneDerivatives::push_forward(const Points& x, const Vector& change, Points& g) const {
  if (change[0] != 0) g += change[0] * force_derivative(x);
}

}  // namespace coapt
