#include "formats/json/json_text.hpp"
#include "scene/file/schema.hpp"
#include "scene/interventions/intervention.hpp"
#include "scene/terms/term_types.hpp"

#include <cmath>

namespace coapt {
namespace {

OrderedJson reference(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }

OrderedJson object_schema(const ObjectSpec& spec);

void add_limits(const KeySpec& key, OrderedJson& number) {
  if (std::isfinite(key.min)) number[key.excludes_min ? "exclusiveMinimum" : "minimum"] = key.min;
  if (std::isfinite(key.max)) number["maximum"] = key.max;
}

// A bare number for lengths and pure numbers, zero for all, else a number with a unit as text.
OrderedJson quantity_schema(const KeySpec& key) {
  OrderedJson number{{"type", "number"}};
  add_limits(key, number);
  const bool takes_bare = key.dimension == kLength || key.dimension == kDimensionless;
  if (!takes_bare) number["const"] = 0;
  return {{"anyOf", {number, reference(key.dimension == kDimensionless ? "numberText" : "quantityText")}}};
}

OrderedJson one_or_list(const OrderedJson& entry) {
  return {{"anyOf", {entry, {{"type", "array"}, {"items", entry}, {"minItems", 1}}}}};
}

OrderedJson vector_schema(const OrderedJson& entry) {
  return {{"type", "array"}, {"items", entry}, {"minItems", 3}, {"maxItems", 3}};
}

OrderedJson line_schema() {
  const OrderedJson point = vector_schema(quantity_schema({.dimension = kLength}));
  OrderedJson line;
  line["anyOf"] = {reference("nodes"),
                   {{"type", "array"}, {"items", point}, {"minItems", 2}, {"maxItems", 2}}};
  return line;
}

OrderedJson direction_schema() {
  OrderedJson direction;
  direction["anyOf"] = {{{"enum", {"along", "across"}}}, vector_schema({{"type", "number"}})};
  return direction;
}

OrderedJson value_schema(const KeySpec& key) {
  OrderedJson text{{"type", "string"}, {"minLength", 1}};
  switch (key.kind) {
    case KeyKind::Quantity:
      return quantity_schema(key);
    case KeyKind::Quantities:
      return {{"type", "array"}, {"items", quantity_schema(key)}, {"minItems", 1}};
    case KeyKind::Integer: {
      OrderedJson schema{{"type", "integer"}};
      add_limits(key, schema);
      for (const std::string& choice : key.choices) schema["enum"].push_back(std::stoi(choice));
      return schema;
    }
    case KeyKind::Integers: {
      OrderedJson number{{"type", "integer"}};
      add_limits(key, number);
      return one_or_list(number);
    }
    case KeyKind::Flag:
      return {{"type", "boolean"}};
    case KeyKind::Text:
    case KeyKind::File:
      return text;
    case KeyKind::Texts:
      return one_or_list(text);
    case KeyKind::Choice:
      return {{"enum", key.choices}};
    case KeyKind::Triple:
      return vector_schema(quantity_schema(key));
    case KeyKind::Axes:
      return {
          {"anyOf", {{{"type", "boolean"}}, {{"type", "array"}, {"items", {{"enum", {"x", "y", "z"}}}}}}}};
    case KeyKind::Nodes:
      return reference("nodes");
    case KeyKind::NodeSets:
      return {{"type", "object"}, {"additionalProperties", reference("nodes")}};
    case KeyKind::Targets: {
      OrderedJson target;
      target["anyOf"] = {text, object_schema(target_spec())};
      return one_or_list(target);
    }
    case KeyKind::Line:
      return line_schema();
    case KeyKind::Direction:
      return direction_schema();
    case KeyKind::Object:
      return object_schema(key.object);
    case KeyKind::Objects:
      return {{"type", "array"}, {"items", object_schema(key.object)}};
    case KeyKind::Terms:
      return {{"type", "array"}, {"items", reference("term")}, {"minItems", 1}};
    case KeyKind::Interventions:
      return {{"type", "array"}, {"items", reference("intervention")}};
  }
  return {};
}

OrderedJson group_schema(const KeyGroup& group) {
  OrderedJson options = OrderedJson::array();
  for (const std::string& key : group.keys) options.push_back({{"required", {key}}});
  return {{group.exactly_one ? "oneOf" : "anyOf", options}};
}

OrderedJson object_schema(const ObjectSpec& spec) {
  OrderedJson schema{{"type", "object"}};
  OrderedJson required = OrderedJson::array();
  for (const KeySpec& key : spec.keys) {
    OrderedJson value{{"description", key.doc}};
    value.update(value_schema(key));
    if (!key.fallback.empty() && key.kind != KeyKind::Object)
      value["default"] = OrderedJson::parse(key.fallback);
    schema["properties"][key.name] = value;
    if (key.required) required.push_back(key.name);
  }
  if (!required.empty()) schema["required"] = required;
  for (const KeyGroup& group : spec.groups) schema["allOf"].push_back(group_schema(group));
  schema["additionalProperties"] = false;
  return schema;
}

OrderedJson nodes_schema() {
  OrderedJson schema{{"description", "Name of a node set, list of node numbers from 0, or where they lie."}};
  schema["anyOf"] = {{{"type", "string"}},
                     {{"type", "array"}, {"items", {{"type", "integer"}, {"minimum", 0}}}},
                     object_schema(selection_spec())};
  return schema;
}

// Of a term or an intervention.
template <class Type>
OrderedJson typed_schema(const Type& type, const std::vector<KeySpec>& common) {
  ObjectSpec spec = type.spec;
  spec.keys.insert(spec.keys.begin(), common.begin(), common.end());
  OrderedJson schema{{"description", type.summary}};
  schema.update(object_schema(spec));
  schema["properties"]["type"] = {{"const", type.name}};
  return schema;
}

}  // namespace

std::string json_schema() {
  const std::string number = "[+-]?([0-9]+[.]?[0-9]*|[.][0-9]+)([eE][+-]?[0-9]+)?";
  OrderedJson schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                     {"title", "Coapt scene"},
                     {"description",
                      "Lengths in mm unless a unit is written; every other quantity is a text with "
                      "its unit. Comments (//) are allowed in the file."}};
  schema.update(object_schema(scene_spec()));
  OrderedJson& definitions = schema["$defs"];
  definitions["quantityText"] = {{"type", "string"},
                                 {"pattern", "^\\s*" + number + "\\s*[A-Za-z%\\u00b5\\u03bc/].*$"}};
  definitions["numberText"] = {{"type", "string"}, {"pattern", "^\\s*" + number + "\\s*%?\\s*$"}};
  definitions["nodes"] = nodes_schema();
  OrderedJson terms = OrderedJson::array();
  for (const TermType& type : term_types()) {
    terms.push_back(reference("term_" + type.name));
    definitions["term_" + type.name] = typed_schema(type, common_term_keys());
  }
  definitions["term"]["oneOf"] = terms;
  OrderedJson interventions = OrderedJson::array();
  for (const InterventionType& type : intervention_types()) {
    interventions.push_back(reference("intervention_" + type.name));
    definitions["intervention_" + type.name] = typed_schema(type, common_intervention_keys());
  }
  definitions["intervention"]["oneOf"] = interventions;
  return json_text(schema, 2) + "\n";
}

}  // namespace coapt
