// The material laws of a FEBio model as terms of a scene.
#pragma once

#include "formats/defects.hpp"
#include "formats/valve.hpp"

#include <pugixml.hpp>

#include <optional>
#include <string>
#include <vector>

namespace coapt::formats {

// The XML tree with places for messages.
class FebioPlaces {
 public:
  FebioPlaces(std::string_view bytes, Defects& defects) : bytes_(bytes), defects_(defects) {}

  void add(const pugi::xml_node& node, const std::string& what) const;
  // Numbers between commas or blanks. Defects are added; then nothing is returned.
  std::optional<std::vector<double>> numbers(const pugi::xml_node& node, const std::string& text) const;
  std::optional<double> number(const pugi::xml_node& node) const;  // the node's text
  // The node's children of that name, one number each; `otherwise` where there is none.
  double number_or(const pugi::xml_node& parent, const char* name, double otherwise) const;
  double required(const pugi::xml_node& parent, const char* name) const;

 private:
  std::string_view bytes_;
  Defects& defects_;
};

// The child with that tag whose name or id is `name`; none where there is no such child.
pugi::xml_node febio_named(const pugi::xml_node& parent, const char* tag, const std::string& name);

// A law of shells: "isotropic elastic" as cst_stvk, "neo-Hookean" and "incomp neo-Hookean" (and
// "Mooney-Rivlin" without c2) as cst_neo_hookean, "isotropic Lee-Sacks" and "uncoupled isotropic Lee-Sacks"
// as cst_exponential. An uncoupled law is taken as incompressible. Adds a defect where there is no such law.
std::optional<Material> febio_shell_law(const pugi::xml_node& material, double thickness,
                                        const FebioPlaces& places);

struct FebioSpring {
  double rest_length = 0, area = 0;
  Material law;
  bool pushes = false;  // resists shortening too
};

// A law of springs, of nodes at `distance`: "linear spring", "tension-only linear spring", and "nonlinear
// spring" with a curve that is zero up to a point and has one slope (cable)
// or two (cable_bilinear) behind it; with more slopes the law has no type.
std::optional<FebioSpring> febio_spring(const pugi::xml_node& material, double distance,
                                        const FebioPlaces& places);

}  // namespace coapt::formats
