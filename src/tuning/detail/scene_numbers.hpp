// Numbers of a scene's elastic terms as parameters of an equilibrium. Private to this room.
#pragma once

#include "scene/build/scene_geometry.hpp"
#include "scene/file/scene_parameter.hpp"
#include "sensitivity/parameters/parameter.hpp"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace coapt {

// The scene as it was given, and by which factors its numbers have been changed since.
class SceneNumbers : public std::enable_shared_from_this<SceneNumbers> {
 public:
  SceneNumbers(Scene scene, SceneGeometry&& geometry)
      : scene_(std::move(scene)), geometry_(std::move(geometry)) {}

  // Those of one term, which is one of the objective's, by key. None for a load or a contact.
  std::vector<std::string> keys_of(const EnergyTerm& term, const Objective& objective) const;

  // The parameter TERM.KEY. Pre: one of the above.
  std::unique_ptr<Parameter> make(const std::string& name, const Objective& objective);

 private:
  using Terms = std::vector<std::unique_ptr<EnergyTerm>>;

  Scene with(const SceneParameter& parameter, double factor) const;

  Scene scene_;
  SceneGeometry geometry_;
  std::map<std::string, std::pair<SceneParameter, double>> factors_;
};

}  // namespace coapt
