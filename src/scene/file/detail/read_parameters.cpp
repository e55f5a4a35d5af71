#include "scene/file/detail/read_parameters.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/file_kind.hpp"
#include "formats/json/json_text.hpp"
#include "formats/json/suggestion.hpp"
#include "scene/file/detail/read_item.hpp"
#include "scene/interventions/intervention.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace coapt {
namespace {

std::string join(const std::string& where, const std::string& key) { return Parameters(where).where(key); }

std::string limits_text(const KeySpec& key) {
  const std::string unit =
      key.dimension == kDimensionless ? "" : std::string(" ").append(internal_unit(key.dimension));
  std::string text;
  if (std::isfinite(key.min))
    text = (key.excludes_min ? "greater than " : "at least ") + number_text(key.min, 6) + unit;
  if (std::isfinite(key.max))
    text += (text.empty() ? "at most " : " and at most ") + number_text(key.max, 6) + unit;
  return text;
}

std::optional<double> within_limits(double value, const Item& item) {
  const KeySpec& key = item.key;
  if (!(std::abs(value) <= kGreatestNumber)) {
    item.refuse(
        "read " + shown(item.json) + ", with which nothing can be computed: it is beyond 1e50" +
        (key.dimension == kDimensionless ? "" : std::string(" ").append(internal_unit(key.dimension))) +
        "; is its unit right?");
    return std::nullopt;
  }
  if (value < key.min || value > key.max || (key.excludes_min && value == key.min)) {
    item.refuse("read " + shown(item.json) + "; must be " + limits_text(key));
    return std::nullopt;
  }
  return value;
}

std::optional<double> read_quantity(const Item& item) {
  const Dimension dimension = item.key.dimension;
  const std::string wanted = dimension == kDimensionless ? "a number"
                                                         : "a " + dimension_name(dimension) + " such as \"" +
                                                               dimension_example(dimension) + "\"";
  if (item.json.is_number()) {
    const double value = item.json.get<double>();
    if (dimension == kDimensionless || dimension == kLength || value == 0) return within_limits(value, item);
    item.refuse("read " + shown(item.json) + ", which has no unit; expected " + wanted);
    return std::nullopt;
  }
  if (!item.json.is_string()) {
    item.refuse_type(wanted);
    return std::nullopt;
  }
  try {
    const std::string& text = item.json.get_ref<const std::string&>();
    // In a text a length needs its unit too: a number in quotes looks like an unfinished quantity.
    return within_limits(quantity_value(text, dimension), item);
  } catch (const InputError& error) {
    item.refuse(error.what());
    return std::nullopt;
  }
}

std::optional<std::vector<double>> read_quantities(const Item& item) {
  if (!item.json.is_array() || item.json.empty()) {
    item.refuse_type("a list");
    return std::nullopt;
  }
  std::vector<double> values;
  for (size_t k = 0; k < item.json.size(); ++k)
    if (const auto value =
            read_quantity({item.json[k], item.key, item.where + "[" + std::to_string(k) + "]", item.reading}))
      values.push_back(*value);
  return values.size() == item.json.size() ? std::optional(values) : std::nullopt;
}

std::optional<double> read_integer(const Item& item) {
  if (!item.json.is_number_integer()) {
    item.refuse_type("a whole number");
    return std::nullopt;
  }
  const std::vector<std::string>& choices = item.key.choices;
  if (!choices.empty() && std::find(choices.begin(), choices.end(), json_text(item.json)) == choices.end()) {
    item.refuse("read " + shown(item.json) + "; expected one of " + listed(choices));
    return std::nullopt;
  }
  constexpr double kGreatest = 2147483647;
  const double value = item.json.get<double>();
  if (std::abs(value) > kGreatest) {
    item.refuse("read " + shown(item.json) + "; must be at most 2147483647");
    return std::nullopt;
  }
  return within_limits(value, item);
}

std::optional<std::vector<double>> read_integers(const Item& item) {
  if (!item.json.is_array()) {
    const auto value = read_integer(item);
    return value ? std::optional(std::vector<double>{*value}) : std::nullopt;
  }
  if (item.json.empty()) {
    item.refuse_type("a whole number or a list of them");
    return std::nullopt;
  }
  std::vector<double> values;
  for (size_t k = 0; k < item.json.size(); ++k)
    if (const auto value =
            read_integer({item.json[k], item.key, item.where + "[" + std::to_string(k) + "]", item.reading}))
      values.push_back(*value);
  return values.size() == item.json.size() ? std::optional(values) : std::nullopt;
}

std::optional<std::string> read_text_value(const Item& item) {
  if (item.json.is_string() && !item.json.get_ref<const std::string&>().empty())
    return item.json.get<std::string>();
  item.refuse_type("a text");
  return std::nullopt;
}

std::optional<std::string> read_choice(const Item& item) {
  const std::string wanted = "one of " + listed(item.key.choices);
  if (!item.json.is_string()) {
    item.refuse_type(wanted);
    return std::nullopt;
  }
  const std::string text = item.json.get<std::string>();
  for (const std::string& choice : item.key.choices)
    if (choice == text) return text;
  item.refuse("read " + shown(item.json) + "; expected " + wanted + suggestion(text, item.key.choices));
  return std::nullopt;
}

std::optional<std::vector<std::string>> read_texts(const Item& item) {
  std::vector<std::string> texts;
  const auto is_text = [](const Json& entry) { return entry.is_string(); };
  if (item.json.is_string()) {
    texts.push_back(item.json.get<std::string>());
  } else if (item.json.is_array() && !item.json.empty() &&
             std::all_of(item.json.begin(), item.json.end(), is_text)) {
    texts = item.json.get<std::vector<std::string>>();
  } else {
    item.refuse_type("a text or a list of texts");
    return std::nullopt;
  }
  return texts;
}

std::optional<std::vector<Parameters>> read_objects(const Item& item) {
  if (!item.json.is_array()) {
    item.refuse_type("a list of objects");
    return std::nullopt;
  }
  std::vector<Parameters> objects;
  for (size_t k = 0; k < item.json.size(); ++k)
    objects.push_back(
        read_object(item.json[k], item.key.object, item.where + "[" + std::to_string(k) + "]", item.reading));
  return objects;
}

// An object whose `type` selects the table of its other keys: a term or an intervention.
template <class Type>
std::optional<Parameters> read_typed(const Item& item, const std::vector<Type>& types,
                                     const std::vector<KeySpec>& common) {
  std::vector<std::string> names;
  for (const Type& type : types) names.push_back(type.name);
  const std::string wanted = "expected one of " + listed(names);
  if (!item.json.is_object()) {
    item.refuse_type("an object with a `type`");
    return std::nullopt;
  }
  const auto type = item.json.find("type");
  if (type == item.json.end() || !type->is_string()) {
    item.reading.defects.push_back(join(item.where, "type") + ": missing; " + wanted);
    return std::nullopt;
  }
  const std::string name = type->template get<std::string>();
  const auto entry = std::find(names.begin(), names.end(), name);
  if (entry == names.end()) {
    item.reading.defects.push_back(join(item.where, "type") + ": read " + shown(*type) + "; " + wanted +
                                   suggestion(name, names));
    return std::nullopt;
  }
  const Type& found = types[static_cast<size_t>(entry - names.begin())];
  ObjectSpec spec = found.spec;
  spec.keys.insert(spec.keys.begin(), common.begin(), common.end());
  const size_t before = item.reading.defects.size();
  Parameters values = read_object(item.json, spec, item.where, item.reading);
  if (found.check && item.reading.defects.size() == before)
    for (const std::string& defect : found.check(values)) item.refuse(defect);
  return values;
}

template <class Type>
std::optional<std::vector<Parameters>> read_all_typed(const Item& item, const std::vector<Type>& types,
                                                      const std::vector<KeySpec>& common,
                                                      const std::string& plural) {
  if (!item.json.is_array()) {
    item.refuse_type("a list of " + plural);
    return std::nullopt;
  }
  std::vector<Parameters> all;
  for (size_t k = 0; k < item.json.size(); ++k) {
    const std::string where = item.where + "[" + std::to_string(k) + "]";
    if (auto values = read_typed({item.json[k], item.key, where, item.reading}, types, common))
      all.push_back(*values);
  }
  return all;
}

void read_value(const Item& item, Parameters& values) {
  const auto keep = [&](auto&& value) {
    if (value) values.set(item.key.name, std::move(*value));
  };
  switch (item.key.kind) {
    case KeyKind::Quantity:
      return keep(read_quantity(item));
    case KeyKind::Quantities:
      return keep(read_quantities(item));
    case KeyKind::Integer:
      return keep(read_integer(item));
    case KeyKind::Integers:
      return keep(read_integers(item));
    case KeyKind::Flag:
      if (!item.json.is_boolean()) return item.refuse_type("true or false");
      return values.set(item.key.name, item.json.get<bool>());
    case KeyKind::Text:
      return keep(read_text_value(item));
    case KeyKind::Texts:
      return keep(read_texts(item));
    case KeyKind::Choice:
      return keep(read_choice(item));
    case KeyKind::File:
      return keep(read_file(item));
    case KeyKind::Triple:
      return keep(read_vector(item));
    case KeyKind::Axes:
      return keep(read_axes(item));
    case KeyKind::Nodes:
      return keep(read_nodes(item));
    case KeyKind::NodeSets:
      return keep(read_node_sets(item));
    case KeyKind::Targets:
      return keep(read_targets(item));
    case KeyKind::Line:
      return keep(read_line(item));
    case KeyKind::Direction:
      return keep(read_direction(item));
    case KeyKind::Object:
      return values.set(item.key.name, std::vector<Parameters>{read_object(item.json, item.key.object,
                                                                           item.where, item.reading)});
    case KeyKind::Objects:
      return keep(read_objects(item));
    case KeyKind::Terms:
      return keep(read_all_typed(item, term_types(), common_term_keys(), "terms"));
    case KeyKind::Interventions:
      return keep(read_all_typed(item, intervention_types(), common_intervention_keys(), "interventions"));
  }
}

void check_group(const Json& json, const KeyGroup& group, const std::string& where, Reading& reading) {
  std::vector<std::string> given;
  for (const std::string& key : group.keys)
    if (json.contains(key)) given.push_back(key);
  if (given.empty())
    reading.defects.push_back(where + ": needs " + (group.exactly_one ? "one of " : "at least one of ") +
                              listed(group.keys));
  if (given.size() > 1 && group.exactly_one)
    reading.defects.push_back(where + ": has " + listed(given) + "; only one of them can be given");
}

}  // namespace

std::string shown(const Json& json) {
  constexpr size_t kLongest = 60;
  std::string text = json_text(json);
  return text.size() > kLongest ? text.substr(0, kLongest) + " ..." : text;
}

std::optional<std::string> read_file(const Item& item) {
  std::optional<std::string> text = read_text_value(item);
  if (!text) return std::nullopt;
  const std::vector<std::string>& words = item.key.choices;
  if (std::find(words.begin(), words.end(), *text) != words.end()) return text;
  const std::filesystem::path path = (item.reading.folder / *text).lexically_normal();
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) return path.string();
  if (const auto reason = formats::what_is_no_file(path))
    item.refuse("file " + shown(item.json) + " " + *reason + " (" + path.string() + ")");
  else
    item.refuse("file " + shown(item.json) + " not found; looked for " + path.string());
  return std::nullopt;
}

std::optional<Vec3> read_vector(const Item& item) {
  if (!item.json.is_array() || item.json.size() != 3) {
    item.refuse_type("a list of three (x, y, z)");
    return std::nullopt;
  }
  Vec3 vector;
  bool is_whole = true;
  for (int c = 0; c < 3; ++c) {
    const auto entry =
        read_quantity({item.json[c], item.key, item.where + "[" + std::to_string(c) + "]", item.reading});
    is_whole = is_whole && entry.has_value();
    vector[c] = entry.value_or(0);
  }
  return is_whole ? std::optional(vector) : std::nullopt;
}

Parameters read_object(const Json& json, const ObjectSpec& spec, const std::string& where, Reading& reading) {
  Parameters values(where);
  if (!json.is_object()) {
    reading.defects.push_back(where + ": read " + shown(json) + "; expected an object { ... }");
    return values;
  }
  std::vector<std::string> names;
  for (const KeySpec& key : spec.keys) names.push_back(key.name);
  for (const auto& [name, value] : json.items())
    if (std::find(names.begin(), names.end(), name) == names.end())
      reading.defects.push_back(join(where, name.substr(0, 100)) + ": unknown key" + suggestion(name, names));
  for (const KeySpec& key : spec.keys) {
    const auto found = json.find(key.name);
    if (found != json.end()) {
      read_value({*found, key, join(where, key.name), reading}, values);
    } else if (key.required) {
      reading.defects.push_back(join(where, key.name) + ": missing; " + key.doc);
    } else if (!key.fallback.empty()) {
      read_value({Json::parse(key.fallback), key, join(where, key.name), reading}, values);
    }
  }
  for (const KeyGroup& group : spec.groups) check_group(json, group, where, reading);
  return values;
}

}  // namespace coapt
