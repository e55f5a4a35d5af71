// Derivatives by any number of a scene's terms, without a solve. Private to this room.
#pragma once

#include "scene/build/scene_geometry.hpp"
#include "scene/file/scene.hpp"
#include "sensitivity/parameters/parameter.hpp"

#include <vector>

namespace coapt {

// One factor for each of some numbers of a scene, whatever term they belong to; all are 1 and stay so, as
// only derivatives are asked for: nothing is written. The change of the nodal forces with a factor is the
// central difference between terms that are built with the number made smaller and larger: exact forces,
// whose difference is off by the square of the share.
class SceneDerivatives final : public Parameter {
 public:
  struct Neighbours {
    Scene smaller, larger;
  };

  // share: by which each neighbour differs, in (0, 1). geometry: of all scenes; must outlive this object.
  SceneDerivatives(const SceneGeometry& geometry, std::vector<Neighbours> neighbours, double share);

  Vector value() const override { return Vector::Ones(static_cast<Eigen::Index>(neighbours_.size())); }
  std::string defect(const Vector& value) const override;
  void set(const Vector& /*value*/) override {}
  std::vector<WrittenDatum> written() const override { return {}; }
  Vector pull_back(const Points& x, const Points& weights) const override;
  void push_forward(const Points& x, const Vector& change, Points& g) const override;

 private:
  Points force_derivative(const Neighbours& of, const Points& x) const;

  const SceneGeometry& geometry_;
  std::vector<Neighbours> neighbours_;
  double share_;
};

}  // namespace coapt
