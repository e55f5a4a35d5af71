#include "scene/file/scene_text.hpp"

#include "core/error.hpp"
#include "formats/json/json_text.hpp"
#include "formats/json/read_json.hpp"
#include "formats/json/suggestion.hpp"
#include "formats/text.hpp"
#include "valve/other_files.hpp"

#include <cctype>
#include <charconv>

namespace coapt {
namespace {

constexpr const char* kInterventions = "interventions";

// One step of a path: a key, or a place in a list.
struct Step {
  std::string key;
  long place = -1;  // at or above 0: of a list
};

std::vector<Step> steps_of(const std::string& path) {
  const InputError malformed("\"" + path +
                             "\": no key path; write `ring.size`, `solver.tolerance` or `terms[1].young`");
  std::vector<Step> steps;
  size_t at = 0;
  while (at < path.size()) {
    if (path[at] == '[') {
      const size_t end = path.find(']', at);
      if (end == std::string::npos || steps.empty()) throw malformed;
      long place = 0;
      const char *from = path.data() + at + 1, *to = path.data() + end;
      if (const auto read = std::from_chars(from, to, place);
          read.ptr != to || read.ec != std::errc() || place < 0)
        throw malformed;
      steps.push_back({"", place});
      at = end + 1;
      if (at < path.size() && path[at] == '.') ++at;
      continue;
    }
    const size_t end = std::min(path.find_first_of(".[", at), path.size());
    if (end == at) throw malformed;
    steps.push_back({path.substr(at, end - at)});
    at = end + (end < path.size() && path[end] == '.' ? 1 : 0);
  }
  if (steps.size() < 2) throw malformed;
  return steps;
}

std::vector<std::string> keys_of(const Json& json) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  return keys;
}

// Names of the interventions and terms, as scenes give them: the type where there is no name, with a number
// from the second of it on.
std::vector<std::pair<std::string, Json*>> named_objects(Json& scene) {
  std::vector<std::pair<std::string, Json*>> all;
  for (const char* list : {kInterventions, "terms"}) {
    if (!scene.is_object() || !scene.contains(list) || !scene[list].is_array()) continue;
    std::map<std::string, int> count;
    for (Json& entry : scene[list]) {
      if (!entry.is_object()) continue;
      const auto text = [&](const char* key) {
        return entry.contains(key) && entry[key].is_string() ? entry[key].get<std::string>() : std::string();
      };
      std::string name = text("name");
      if (name.empty()) {
        name = text("type");
        if (const int number = ++count[name]; number > 1) name += "_" + std::to_string(number);
      }
      if (!name.empty()) all.emplace_back(name, &entry);
    }
  }
  return all;
}

Json& first_object(Json& scene, const std::string& name, const std::string& path, const std::string& file) {
  if (scene.is_object() && scene.contains(name)) return scene[name];
  std::vector<std::string> names = scene.is_object() ? keys_of(scene) : std::vector<std::string>();
  for (auto& [known, entry] : named_objects(scene)) {
    if (known == name) return *entry;
    names.push_back(known);
  }
  throw InputError(file + ": \"" + path + "\": there is no key, intervention or term \"" + name +
                   "\"; there are: " + listed(names) + suggestion(name, names));
}

// "26" beside "30 mm" becomes "26 mm"; a number stays one; anything else is JSON or a text.
Json value_of(const std::string& value, const Json& before) {
  double number = 0;
  const bool is_number = !formats::read_number(value, number).has_value();
  if (is_number && before.is_string()) {
    const std::string& text = before.get_ref<const std::string&>();
    const size_t unit = text.find_first_not_of("0123456789+-.eE ");
    if (unit != std::string::npos) return value + " " + text.substr(unit);
  }
  const Json read = Json::parse(value, nullptr, false);
  return read.is_discarded() ? Json(value) : read;
}

}  // namespace

std::string scene_text(const std::filesystem::path& file) {
  refuse_other_file(file);
  return read_text(file);
}

std::string without_interventions(const std::string& scene, const std::string& file) {
  Json json = parse_json(scene, file);
  if (json.is_object()) json.erase(kInterventions);
  return json_text(json, 2) + "\n";
}

std::string with_interventions(const std::string& scene, const std::vector<std::string>& more,
                               const std::string& file, const std::string& source) {
  Json json = parse_json(scene, file);
  if (!json.is_object()) return scene;
  Json& list = json.emplace(kInterventions, Json::array()).first.value();
  if (!list.is_array()) return scene;
  for (const std::string& text : more) {
    const Json added = parse_json(text, source);
    if (!added.is_object() && !added.is_array())
      throw InputError(source + ": read " + text +
                       "; expected an intervention, as in {\"type\": \"ring\", \"size\": "
                       "\"30 mm\"}, or a list of them");
    if (added.is_object()) {
      list.push_back(added);
    } else {
      for (const Json& entry : added) list.push_back(entry);
    }
  }
  return json_text(json, 2) + "\n";
}

std::vector<std::string> intervention_texts(const std::string& scene, const std::string& file) {
  const Json json = parse_json(scene, file);
  std::vector<std::string> texts;
  if (json.is_object() && json.contains(kInterventions) && json[kInterventions].is_array())
    for (const Json& entry : json[kInterventions]) texts.push_back(json_text(entry));
  return texts;
}

std::string with_value(const std::string& scene, const std::string& path, const std::string& value,
                       const std::string& file) {
  Json json = parse_json(scene, file);
  const std::vector<Step> steps = steps_of(path);
  Json* place = &first_object(json, steps.front().key, path, file);
  std::string walked = steps.front().key;
  for (size_t k = 1; k < steps.size(); ++k) {
    const Step& step = steps[k];
    if (step.place >= 0) {
      if (!place->is_array() || place->size() <= static_cast<size_t>(step.place))
        throw InputError(file + ": \"" + path + "\": \"" + walked + "\" has no entry " +
                         std::to_string(step.place));
      place = &(*place)[static_cast<size_t>(step.place)];
      walked += "[" + std::to_string(step.place) + "]";
      continue;
    }
    const bool is_last = k + 1 == steps.size();
    if (!place->is_object() || (!is_last && !place->contains(step.key)))
      throw InputError(file + ": \"" + path + "\": \"" + walked + "\" has no key \"" + step.key + "\"" +
                       (place->is_object() ? "; it has: " + listed(keys_of(*place)) : ""));
    place = &(*place)[step.key];
    walked += "." + step.key;
  }
  *place = value_of(value, *place);
  return json_text(json, 2) + "\n";
}

}  // namespace coapt
