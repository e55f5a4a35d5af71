#include "exchange/reference_page.hpp"

#include "scene/file/schema.hpp"
#include "scene/interventions/intervention.hpp"
#include "scene/terms/term_types.hpp"

#include <cmath>
#include <sstream>

namespace coapt {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "`" : ", `") + word + "`";
  return text;
}

std::string kind_text(const KeySpec& key) {
  switch (key.kind) {
    case KeyKind::Quantity:
      return key.dimension == kDimensionless
                 ? "number"
                 : dimension_name(key.dimension) + ", `\"" + dimension_example(key.dimension) + "\"`";
    case KeyKind::Quantities:
      return key.dimension == kDimensionless ? "list of numbers"
                                             : "list, each a " + dimension_name(key.dimension) + ", `\"" +
                                                   dimension_example(key.dimension) + "\"`";
    case KeyKind::Integer:
      return key.choices.empty() ? "whole number" : "one of " + joined(key.choices);
    case KeyKind::Integers:
      return "whole number or list of them";
    case KeyKind::Flag:
      return "`true` or `false`";
    case KeyKind::Text:
      return "text";
    case KeyKind::Texts:
      return "text or list of texts";
    case KeyKind::Choice:
      return "one of " + joined(key.choices);
    case KeyKind::File:
      return key.choices.empty() ? "file" : "file, or " + joined(key.choices);
    case KeyKind::Triple:
      return key.dimension == kDimensionless ? "`[x, y, z]`"
                                             : "`[x, y, z]`, each a " + dimension_name(key.dimension);
    case KeyKind::Axes:
      return "`true`, `false`, or some of `[\"x\", \"y\", \"z\"]`";
    case KeyKind::Nodes:
      return "[nodes](#nodes)";
    case KeyKind::NodeSets:
      return "name: [nodes](#nodes)";
    case KeyKind::Targets:
      return "file, name, `{\"translate\": [x, y, z]}`, or a list";
    case KeyKind::Line:
      return "[nodes](#nodes) or two points";
    case KeyKind::Direction:
      return "`\"along\"`, `\"across\"` or `[x, y, z]`";
    case KeyKind::Object:
      return "object";
    case KeyKind::Objects:
      return "list of objects";
    case KeyKind::Terms:
      return "list of [terms](#terms)";
    case KeyKind::Interventions:
      return "list of [interventions](#interventions)";
  }
  return "";
}

std::string limits_text(const KeySpec& key) {
  std::ostringstream text;
  const std::string unit =
      key.dimension == kDimensionless ? "" : std::string(" ").append(internal_unit(key.dimension));
  if (std::isfinite(key.min)) text << (key.excludes_min ? "> " : "≥ ") << key.min << unit;
  if (std::isfinite(key.min) && std::isfinite(key.max)) text << ", ";
  if (std::isfinite(key.max)) text << "≤ " << key.max << unit;
  return text.str();
}

std::string default_text(const KeySpec& key) {
  if (key.required) return "required";
  return key.fallback.empty() || key.kind == KeyKind::Object ? "" : "`" + key.fallback + "`";
}

std::string table(const ObjectSpec& spec) {
  std::string text = "| key | value | default | limits | meaning |\n|---|---|---|---|---|\n";
  for (const KeySpec& key : spec.keys)
    text += "| `" + key.name + "` | " + kind_text(key) + " | " + default_text(key) + " | " +
            limits_text(key) + " | " + key.doc + " |\n";
  for (const KeyGroup& group : spec.groups)
    text += std::string("\n") + (group.exactly_one ? "Exactly one of " : "At least one of ") +
            joined(group.keys) + " must be given.\n";
  return text + "\n";
}

// The tables of the objects among the keys, each under its own heading.
std::string parts(const ObjectSpec& spec) {
  std::string text;
  for (const KeySpec& key : spec.keys)
    if (!key.object.keys.empty())
      text += "## " + key.name + "\n\n" + key.doc + "\n\n" + table(key.object) + parts(key.object);
  return text;
}

constexpr const char* kIntroduction = R"(# The scene file

This page is written by the same table that validates scenes; `schema/scene.schema.json` is its other form.

A scene is JSON in which `//` comments are allowed. Relative paths start from the scene's folder. Quantities
are texts with a unit (`"120 mmHg"`, `"0.65 mm"`, `"9.81 m/s^2"`; see [units](units.md)). A bare number is
taken where only a length in mm or a pure number can be meant; zero needs no unit anywhere. Keys that are not
listed here are errors.

)";

constexpr const char* kNodes = R"(## Nodes

Nodes are the vertices of the mesh, counted from 0, followed by the anchors and then the free branch points
of each network in the order in which terms name them. Messages about vertices and triangles of the mesh count
them as its file does: an OBJ from 1, and then they say so. A selection is one of

- the name of a set: one of `sets`; `"all"`; `"boundary"` (the nodes on the mesh's rims, loop after loop); a
  region of the mesh; `"papillary"` and `"junctions"` of the networks; any list of vertex numbers in the
  file `mesh.sets` or in a network's file (`"annulus"`, `"free_edge"`, `"commissures"`);
- a list of node numbers, `[0, 17, 4]`;
- an object that says where they lie, in the coordinates of the mesh file and in mm:

)";

}  // namespace

std::string reference_page() {
  std::string text = kIntroduction;
  text += table(scene_spec());
  text += parts(scene_spec());
  text += kNodes;
  text += table(selection_spec());
  for (const KeySpec& key : selection_spec().keys)
    if (!key.object.keys.empty()) text += "`" + key.name + "`:\n\n" + table(key.object);
  text += "## Terms\n\n" + table({common_term_keys(), {}});
  for (const TermType& type : term_types())
    text += "### " + type.name + "\n\n" + type.summary + "\n\n" + table(type.spec);
  text += "## Interventions\n\nWhat each does to the valve: [interventions](interventions.md).\n\n" +
          table({common_intervention_keys(), {}});
  for (const InterventionType& type : intervention_types())
    text += "### " + type.name + "\n\n" + type.summary + "\n\n" + table(type.spec);
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

}  // namespace coapt
