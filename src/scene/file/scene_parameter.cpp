#include "scene/file/scene_parameter.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/json/suggestion.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr const char* kDiameter = "diameter";
constexpr const char* kAreaScale = "area_scale";  // of which the diameter is the root

bool is_numeric(const KeySpec& key) {
  return key.kind == KeyKind::Quantity || key.kind == KeyKind::Quantities;
}

const KeySpec* find_key(const TermSpec& term, const std::string& name) {
  for (const KeySpec& key : find_term_type(term.type)->spec.keys)
    if (key.name == name && is_numeric(key)) return &key;
  return nullptr;
}

// Those of its numbers that have a value.
std::vector<std::string> numbers_of(const TermSpec& term) {
  std::vector<std::string> names;
  for (const KeySpec& key : find_term_type(term.type)->spec.keys)
    if (is_numeric(key) && term.parameters.has(key.name) && key.name != kAreaScale) names.push_back(key.name);
  if (is_elastic_cable(term)) names.emplace_back(kDiameter);
  return names;
}

// `length` and `pressure`, as an equilibrium that is followed calls them, are the keys `length_scale` and
// `value`.
std::string key_of(const std::string& said, const std::vector<std::string>& known) {
  for (const auto& [name, key] : {std::pair("length", "length_scale"), std::pair("pressure", "value")})
    if (said == name && std::find(known.begin(), known.end(), said) == known.end() &&
        std::find(known.begin(), known.end(), key) != known.end())
      return key;
  return said;
}

SceneParameter parameter_of(const Scene& scene, size_t index, const std::string& key) {
  const TermSpec& term = scene.terms[index];
  if (key == kDiameter && is_elastic_cable(term))
    return {term.name + "." + key, index, kAreaScale, 2, 1, kDimensionless};
  if (find_key(term, key)->kind == KeyKind::Quantities)
    return {term.name + "." + key, index, key, 1, 1, kDimensionless};
  return {term.name + "." + key, index, key, 1, term.parameters.number(key), find_key(term, key)->dimension};
}

// The rules between the keys of a term that was changed.
void check_term(const TermSpec& term, const SceneParameter& parameter, double factor) {
  const TermType& type = *find_term_type(term.type);
  if (!type.check) return;
  if (const std::vector<std::string> defects = type.check(term.parameters); !defects.empty())
    throw InputError(term.parameters.where() + ": with " + parameter.name + " times " +
                     number_text(factor, 6) + ": " + defects.front());
}

}  // namespace

bool is_elastic_cable(const TermSpec& term) {
  return term.parameters.has(kAreaScale) && !term.parameters.has("tension");
}

SceneParameter find_parameter(const Scene& scene, const std::string& name) {
  std::vector<std::string> terms;
  for (const TermSpec& term : scene.terms) terms.push_back(term.name);
  // A name of a term may itself have dots; one of a key has none.
  const size_t dot = name.rfind('.');
  if (dot == std::string::npos)
    throw InputError("parameter \"" + name + "\": expected TERM.KEY, as in \"" + terms.at(0) +
                     ".young\"; the scene's terms: " + listed(terms));
  const std::string term_name = name.substr(0, dot);
  const auto found = std::find(terms.begin(), terms.end(), term_name);
  if (found == terms.end())
    throw InputError("parameter \"" + name + "\": the scene has no term \"" + term_name +
                     "\"; its terms: " + listed(terms) + suggestion(term_name, terms));
  const auto index = static_cast<size_t>(found - terms.begin());
  const std::vector<std::string> known = numbers_of(scene.terms[index]);
  const std::string key = key_of(name.substr(dot + 1), known);
  if (std::find(known.begin(), known.end(), key) == known.end() && key != kAreaScale)
    throw InputError("parameter \"" + name + "\": term \"" + term_name + "\" has no number \"" + key +
                     "\"; it has: " + listed(known) + suggestion(key, known));
  SceneParameter parameter = parameter_of(scene, index, key);
  if (parameter.value == 0) throw InputError("parameter \"" + name + "\": is zero, which no factor changes");
  return parameter;
}

std::vector<SceneParameter> elastic_parameters(const Scene& scene, const Objective& objective) {
  std::vector<SceneParameter> parameters;
  for (size_t k = 0; k < scene.terms.size(); ++k) {
    const bool is_elastic =
        std::any_of(objective.terms().begin(), objective.terms().end(), [&](const auto& term) {
          return term->name() == scene.terms[k].name && term->role() == TermRole::Internal;
        });
    if (!is_elastic) continue;
    for (const std::string& key : numbers_of(scene.terms[k])) {
      const SceneParameter parameter = parameter_of(scene, k, key);
      if (parameter.value != 0) parameters.push_back(parameter);
    }
  }
  return parameters;
}

Scene scaled(Scene scene, const SceneParameter& parameter, double factor) {
  TermSpec& term = scene.terms.at(parameter.term);
  const KeySpec& key = *find_key(term, parameter.key);
  if (key.kind == KeyKind::Quantities) {
    std::vector<double> numbers = term.parameters.numbers(key.name);
    for (double& number : numbers) number *= factor;
    term.parameters.set(key.name, std::move(numbers));
    check_term(term, parameter, factor);
    return scene;
  }
  const double change = std::pow(factor, parameter.power),
               value = term.parameters.number(parameter.key) * change;
  if (!std::isfinite(value) || value < key.min || value > key.max || (key.excludes_min && value == key.min))
    throw InputError(term.parameters.where(parameter.key) + ": " + number_text(factor, 6) + " times " +
                     parameter.name + " is beyond the limits of this key (" + number_text(key.min, 6) +
                     " to " + number_text(key.max, 6) + "); perturb it by less, or leave it out");
  term.parameters.scale(parameter.key, change);
  check_term(term, parameter, factor);
  return scene;
}

}  // namespace coapt
