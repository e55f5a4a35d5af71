// Numbers of a scene's terms by name, `TERM.KEY`: what a study of parameters varies.
#pragma once

#include "energy/objective.hpp"
#include "formats/json/units.hpp"
#include "scene/file/scene.hpp"

#include <string>
#include <vector>

namespace coapt {

// A number of a term, or a list of numbers that are scaled together, such as the moduli of an Ogden cable.
// `TERM.diameter`, of a cable, stands for its cross-sections, which go with the square.
struct SceneParameter {
  std::string name;  // TERM.KEY
  size_t term = 0;   // index among the scene's terms
  std::string key;   // that is scaled
  double power = 1;  // of the factor, by which the key is scaled
  double value = 0;  // before any change, in internal units; 1 for a diameter or a list, which have several
  Dimension dimension = kDimensionless;
};

// Whether the term's lines have a cross-section that counts: cables of any law but a constant force.
bool is_elastic_cable(const TermSpec& term);

// TERM.length and TERM.pressure, as an equilibrium that is followed calls them, are found as the keys
// `length_scale` and `value`. Throws InputError for a name that is not TERM.KEY, an unknown term or key
// (listing those there are), a key that is no number, and a number that is not given, or zero: a relative
// change means nothing there.
SceneParameter find_parameter(const Scene& scene, const std::string& name);

// Every number that is not zero, and every list of numbers, of every term that is an internal energy (no
// load, no contact), and the diameters of elastic cables. objective: built from the scene.
std::vector<SceneParameter> elastic_parameters(const Scene& scene, const Objective& objective);

// The scene with the parameter times `factor`. Throws InputError where that is beyond the limits of the key.
Scene scaled(Scene scene, const SceneParameter& parameter, double factor);

}  // namespace coapt
