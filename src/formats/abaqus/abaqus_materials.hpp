// The material laws of an Abaqus input file as terms of a scene.
#pragma once

#include "formats/abaqus/abaqus_cards.hpp"
#include "formats/valve.hpp"

#include <map>
#include <optional>
#include <string>

namespace coapt::formats {

struct AbaqusMaterial {
  std::string name;  // as written
  int line = 0;
  std::optional<AbaqusCard> law;  // the card *Elastic, *Hyperelastic, ...
};
using AbaqusMaterials = std::map<std::string, AbaqusMaterial>;  // by name in upper case

// The law of a shell: *Elastic as cst_stvk; *Hyperelastic, NEO HOOKE as cst_neo_hookean; and as
// cst_exponential (formats/tissue_laws.hpp) the user law of materials named VUANISO_ISO_* with the
// properties C0, D, C1, C2.
// Nothing where the scene has no such law. Defects are added for numbers that cannot be.
std::optional<Material> shell_law(const AbaqusMaterial& material, double thickness, Defects& defects);

// The law of a truss: *Elastic as cable; *Hyperelastic, OGDEN or NEO HOOKE as cable_ogden, whose volume is
// constant whatever D says.
std::optional<Material> truss_law(const AbaqusMaterial& material, Defects& defects);

}  // namespace coapt::formats
