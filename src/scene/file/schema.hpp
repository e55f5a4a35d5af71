// The one table of the scene file: it validates, gives the defaults, and is published as JSON Schema
// and as the reference page.
#pragma once

#include "formats/json/units.hpp"

#include <limits>
#include <string>
#include <vector>

namespace coapt {

enum class KeyKind {
  Quantity,    // text with a unit; a bare number where only a length (mm) or a pure number can be meant
  Quantities,  // a list of them
  Integer,
  Flag,  // true or false
  Text,
  Texts,          // one text or a list of them
  Choice,         // one of `choices`
  File,           // path of an existing file, relative to the scene's folder
  Triple,         // three quantities
  Axes,           // true, false, or a list of "x", "y", "z"
  Nodes,          // node selection
  NodeSets,       // object: name -> node selection
  Targets,        // one target of a motion or a list of them
  Line,           // two nodes or two points
  Direction,      // "along", "across" or a vector
  Object,         // `keys`
  Objects,        // list of objects with `keys`
  Terms,          // list of objects, each with the keys of its type
  Interventions,  // likewise
  Integers        // one whole number or a list of them
};

// Size of a number of a scene, in mm, N and MPa: products of a few such numbers stay within double precision.
inline constexpr double kGreatestNumber = 1e50;

struct KeySpec;

// Of these keys one must be given: exactly one, or at least one.
struct KeyGroup {
  std::vector<std::string> keys;
  bool exactly_one = true;
};

struct ObjectSpec {
  std::vector<KeySpec> keys;
  std::vector<KeyGroup> groups = {};
};

struct KeySpec {
  std::string name = "";
  KeyKind kind = KeyKind::Quantity;
  Dimension dimension = kDimensionless;
  bool required = false;
  std::string fallback = "";  // default as JSON text; empty: none
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool excludes_min = false;
  std::vector<std::string> choices = {};  // of a File: words that stand for something else than a path
  ObjectSpec object = {};
  std::string doc = "";  // one sentence
};

// The whole scene file.
const ObjectSpec& scene_spec();

// The object forms of a node selection and of a motion target.
const ObjectSpec& selection_spec();
const ObjectSpec& target_spec();

// Keys that every term, and every intervention, has besides those of its type.
const std::vector<KeySpec>& common_term_keys();
const std::vector<KeySpec>& common_intervention_keys();

// JSON Schema (draft 2020-12) of the scene file, as text.
std::string json_schema();

}  // namespace coapt
