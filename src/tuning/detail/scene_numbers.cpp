#include "tuning/detail/scene_numbers.hpp"

#include "core/error.hpp"
#include "scene/build/build_parts.hpp"
#include "sensitivity/parameters/line_access.hpp"
#include "sensitivity/parameters/term_number.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace coapt {
namespace {

// Lengths of lines are parameters of their own.
const std::set<std::string> kLengths = {"length", "length_scale"};

}  // namespace

std::vector<std::string> SceneNumbers::keys_of(const EnergyTerm& term, const Objective& objective) const {
  std::vector<std::string> keys;
  for (const SceneParameter& parameter : elastic_parameters(scene_, objective)) {
    const std::string prefix = term.name() + ".", key = parameter.name.substr(parameter.name.rfind('.') + 1);
    if (parameter.name == prefix + key && !kLengths.contains(key)) keys.push_back(key);
  }
  return keys;
}

Scene SceneNumbers::with(const SceneParameter& parameter, double factor) const {
  Scene scene = scene_;
  for (const auto& [name, changed] : factors_)
    if (name != parameter.name) scene = scaled(std::move(scene), changed.first, changed.second);
  return scaled(std::move(scene), parameter, factor);
}

// A cable's number makes its own term anew; one of a membrane may be read by bending, that of bending needs
// the membranes: all that is no line is made anew together.
std::unique_ptr<Parameter> SceneNumbers::make(const std::string& name, const Objective& objective) {
  const SceneParameter parameter = find_parameter(scene_, name);
  const std::string& own = scene_.terms[parameter.term].name;
  TermNumber number;
  number.value = parameter.value;
  number.scale = std::abs(parameter.value);
  const auto is_line = [](EnergyTerm& term) { return line_access(term) != nullptr; };
  const auto found = std::find_if(objective.terms().begin(), objective.terms().end(),
                                  [&](const auto& term) { return term->name() == own; });
  const bool makes_line = is_line(**found);
  std::vector<std::string> names;
  for (const auto& term : objective.terms()) {
    if (makes_line ? term->name() != own : term->role() != TermRole::Internal || is_line(*term)) continue;
    if (std::none_of(scene_.terms.begin(), scene_.terms.end(),
                     [&](const TermSpec& spec) { return spec.name == term->name(); }))
      continue;  // the program's own
    number.terms.push_back(term.get());
    names.push_back(term->name());
  }
  const auto self = shared_from_this();
  number.terms_at = [self, parameter, names](double value) {
    Scene scene = self->with(parameter, value / parameter.value);
    std::erase_if(scene.terms, [&](const TermSpec& spec) {
      return std::find(names.begin(), names.end(), spec.name) == names.end();
    });
    Terms made = build_terms(scene, self->geometry_);
    const auto place = [&](const auto& term) {
      return std::find(names.begin(), names.end(), term->name()) - names.begin();
    };
    std::sort(made.begin(), made.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
    return made;
  };
  number.defect = [self, parameter](double value) -> std::string {
    try {
      self->with(parameter, value / parameter.value);
      return {};
    } catch (const InputError& error) {
      return error.defects().front();
    }
  };
  number.keep = [self, parameter](double value) {
    self->factors_[parameter.name] = {parameter, value / parameter.value};
  };
  return make_term_number(name, std::move(number));
}

}  // namespace coapt
