// Laws of a scene in FEBio's words. Private to this room.
#pragma once

#include "scene/file/scene.hpp"

#include <optional>
#include <string>
#include <vector>

namespace coapt::detail {

struct FebioLaw {
  std::string type;
  std::string keys;                   // XML of the parameters
  std::vector<std::string> warnings;  // sentences without the name of the term
};

// The material of a membrane term; nothing where FEBio has none that is like it.
std::optional<FebioLaw> febio_membrane(const TermSpec& term);

// The curve of a nonlinear spring that stands for a chord of a cable term: force over strain of its
// `distance` at the start [mm], for a rest length [mm] and a cross-section [mm^2]. Nothing where there is
// none.
std::optional<FebioLaw> febio_cable(const TermSpec& term, double distance, double rest_length, double area);

}  // namespace coapt::detail
