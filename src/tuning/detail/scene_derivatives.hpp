// Derivatives by any number of a scene's terms, without a solve. Private to this room.
#pragma once

#include "scene/build/scene_geometry.hpp"
#include "scene/file/scene.hpp"
#include "sensitivity/parameters/parameter.hpp"

namespace coapt {

// A factor on a number of a scene, whatever term it belongs to; it is 1 and stays so, as only derivatives are
// asked for: nothing is written. The change of the nodal forces with the factor is the central difference
// between terms that are built with the number made smaller and larger: exact forces, whose difference is off
// by the square of the share, and by one half where a line is slack on one side alone.
class SceneDerivatives final : public Parameter {
 public:
  struct Neighbours {
    Scene smaller, larger;
  };

  // share: by which each neighbour differs, in (0, 1). geometry: of both scenes; must outlive this object.
  SceneDerivatives(std::string name, const SceneGeometry& geometry, Neighbours neighbours, double share);

  Vector value() const override { return Vector::Ones(1); }
  std::string defect(const Vector& value) const override;
  void set(const Vector& /*value*/) override {}
  std::vector<WrittenDatum> written() const override { return {}; }
  Vector pull_back(const Points& x, const Points& weights) const override;
  void push_forward(const Points& x, const Vector& change, Points& g) const override;

 private:
  Points force_derivative(const Points& x) const;

  const SceneGeometry& geometry_;
  Neighbours neighbours_;
  double share_;
};

}  // namespace coapt
