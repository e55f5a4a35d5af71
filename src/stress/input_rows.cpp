// S20: bad input is refused, with the file and the item named, and nothing is written.
#include "core/error.hpp"
#include "formats/json/read_json.hpp"
#include "formats/whole_file.hpp"
#include "results/results.hpp"
#include "run/run.hpp"
#include "scene/build/build.hpp"
#include "stress/scenes/bad_meshes.hpp"
#include "stress/scenes/bad_scenes.hpp"
#include "stress/scenes/built_in.hpp"
#include "stress/subject.hpp"

#include <algorithm>

namespace coapt {
namespace {

namespace fs = std::filesystem;

// What became of a number of inputs.
struct Tally {
  int shown = 0, wrong = 0;
  std::string first;  // the first that is wrong

  void checker(const std::string& name, const std::string& defect) {
    ++shown;
    if (defect.empty()) return;
    if (wrong++ == 0) first = name + ": " + defect;
  }
  StressOutcome outcome(const std::string& done) const {
    StressOutcome outcome{wrong == 0 ? StressVerdict::Pass : StressVerdict::Fail, wrong, 0};
    outcome.message = std::to_string(shown) + " " + done + (wrong == 0 ? "" : "; " + first);
    return outcome;
  }
};

std::string joined(const std::vector<std::string>& lines) {
  std::string all;
  for (const std::string& line : lines) all += line + "\n";
  return all;
}

std::string missing(const std::string& text, const std::vector<std::string>& wanted) {
  for (const std::string& piece : wanted)
    if (text.find(piece) == std::string::npos)
      return "does not say \"" + piece + "\" but \"" + text.substr(0, text.find('\n')) + "\"";
  return "";
}

size_t file_count(const fs::path& folder) {
  return static_cast<size_t>(std::distance(fs::recursive_directory_iterator(folder), {}));
}

// Solves the scene, as `coapt solve` does; what is wrong with its refusal.
std::string refusal_defect(const StressRunner& bench, const fs::path& folder,
                           const std::vector<std::string>& said) {
  const size_t before = file_count(folder);
  RunOptions options;
  options.factorisations = bench.options().factorisations;
  options.max_seconds = bench.options().row_seconds;
  try {
    run(load_scene(folder / "scene.json"), bench.options().solvers, options);
  } catch (const InputError& error) {
    if (file_count(folder) != before) return "is refused, but files are left behind";
    return missing(joined(error.defects()), said);
  }
  return "is not refused";
}

std::string welcome_defect(const BadMesh& mesh, const fs::path& folder) {
  const Model model = build(load_scene(folder / "scene.json"));
  if (mesh.welcome == Welcome::Accepted)
    return model.warnings.empty() ? "" : "is warned of: " + model.warnings.front();
  return model.warnings.empty() ? "is accepted in silence" : missing(joined(model.warnings), {mesh.said});
}

// Whatever happens: an exception of another kind is a defect like any other.
template <class Judge>
std::string caught(const Judge& checker) {
  try {
    return checker();
  } catch (const InputError& error) {
    return "is refused: " + error.defects().front();
  } catch (const std::exception& error) {
    return std::string("exception: ") + error.what();
  }
}

// The sound scene for a mesh: contact where it matters, and one part held or all of the rim.
std::string scene_for(const BadMesh& mesh) {
  std::string text = kSoundScene;
  const auto replace = [&](const std::string& piece, const std::string& other) {
    text.replace(text.find(piece), piece.size(), other);
  };
  if (mesh.touches) replace("\"0.1 kPa\" }", "\"0.1 kPa\" }, { \"type\": \"contact_barrier\" }");
  if (mesh.holds_one_part) replace("\"boundary\", ", "[0, 1, 2, 3], ");
  return text;
}

fs::path new_folder(const StressRunner& bench, const std::string& name) {
  fs::path folder = bench.options().folder / "scenes" / name;
  prepare_result_folder(folder);
  return folder;
}

StressOutcome shown_meshes(const StressRunner& bench) {
  const fs::path folder = new_folder(bench, "S20_meshes");
  Tally tally;
  for (const BadMesh& mesh : bad_meshes()) {
    formats::write_whole(folder / "mesh.obj", mesh.text);
    formats::write_whole(folder / "scene.json", scene_for(mesh));
    const bool is_of_file = mesh.welcome == Welcome::Refused && !mesh.touches;
    tally.checker(mesh.name, caught([&] {
                    return mesh.welcome == Welcome::Refused
                               ? refusal_defect(bench, folder,
                                                {is_of_file ? "mesh.obj" : "scene.json", mesh.said})
                               : welcome_defect(mesh, folder);
                  }));
  }
  return tally.outcome("meshes, refused, warned of or taken as they must be");
}

StressOutcome shown_scenes(const StressRunner& bench) {
  const fs::path folder = new_folder(bench, "S20_scenes");
  formats::write_whole(folder / "mesh.obj", kSoundMesh);
  formats::write_whole(folder / "far.json", R"({"units": "mm", "papillary": [[0, 0, -1]], "junctions": [],
  "chords": [{"from": {"papillary": 0}, "to": {"leaflet": 9999}, "rest_length": 1, "area": 0.4}]})");
  Tally tally;
  for (BadScene& scene : bad_scenes()) {
    formats::write_whole(folder / "scene.json", scene.text);
    const bool is_of_scene = scene.said.front() != "far.json";
    if (is_of_scene) scene.said.emplace_back("scene.json");
    tally.checker(scene.name, caught([&] { return refusal_defect(bench, folder, scene.said); }));
  }
  formats::write_whole(folder / "scene.json", kSoundScene);
  return tally.outcome("scenes, each refused by name");
}

// --- The user's own scene, spoilt ----------------------------------------------------------------------

// "/terms/0/young" as messages write it: terms[0].young.
std::string place_of(const Json::json_pointer& pointer) {
  std::string text, place;
  for (Json::json_pointer rest = pointer; !rest.empty(); rest.pop_back()) {
    const std::string& key = rest.back();
    const bool is_number = key.find_first_not_of("0123456789") == std::string::npos;
    place = is_number ? "[" + key + "]" + place : "." + key + place;
  }
  return place.starts_with('.') ? place.substr(1) : place;
}

// Objects and plain values of a scene; of a list of numbers the first alone.
void collect(const Json& json, const Json::json_pointer& here, std::vector<Json::json_pointer>& objects,
             std::vector<Json::json_pointer>& values) {
  if (json.is_object()) {
    objects.push_back(here);
    for (const auto& [key, value] : json.items()) collect(value, here / key, objects, values);
  } else if (json.is_array()) {
    const size_t count = !json.empty() && json.front().is_primitive() ? 1 : json.size();
    for (size_t k = 0; k < count; ++k) collect(json[k], here / k, objects, values);
  } else {
    values.push_back(here);
  }
}

struct Spoilt {
  Json scene;
  fs::path file;
  std::vector<Json::json_pointer> objects, values;
};

Spoilt unspoilt(const StressSubject& subject) {
  Spoilt spoilt;
  spoilt.file = subject.scene->scene.file;
  spoilt.scene = read_json(spoilt.file);
  collect(spoilt.scene, Json::json_pointer(), spoilt.objects, spoilt.values);
  return spoilt;
}

// What a scene is refused with; empty: it is not.
std::string refusal(const Json& scene, const fs::path& file) {
  try {
    parse_scene(scene.dump(), file);
  } catch (const InputError& error) {
    return joined(error.defects());
  }
  return "";
}

StressOutcome with_unknown_keys(StressSubject& subject) {
  const std::string key = "no_such_key";
  own_scene(subject);
  Spoilt spoilt = unspoilt(subject);
  for (const auto& place : spoilt.objects) spoilt.scene[place][key] = 1;
  const std::string said = refusal(spoilt.scene, spoilt.file);
  Tally tally;
  for (const auto& place : spoilt.objects) {
    const std::string name = place_of(place / key);
    tally.checker(name, missing(said, {name, spoilt.file.filename().string()}));
  }
  return tally.outcome("keys that nobody knows, all named at once");
}

StressOutcome with_nulls(StressSubject& subject) {
  own_scene(subject);
  const Spoilt spoilt = unspoilt(subject);
  Tally tally;
  for (const auto& place : spoilt.values) {
    Json scene = spoilt.scene;
    scene[place] = nullptr;
    const std::string said = refusal(scene, spoilt.file), name = place_of(place);
    // An entry of a list may be named by the list.
    const std::string list = name.ends_with(']') ? name.substr(0, name.rfind('[')) : name;
    tally.checker(name,
                  said.empty() ? "is not refused" : missing(said, {list, spoilt.file.filename().string()}));
  }
  return tally.outcome("values, each replaced by null, each refused by name");
}

}  // namespace

std::vector<StressRow> bad_input_rows(const StressRunner& bench) {
  return {
      {"S20", "bad input", "meshes", "wrong verdicts", "", true, [bench] { return shown_meshes(bench); }},
      {"S20", "bad input", "scenes", "wrong verdicts", "", true, [bench] { return shown_scenes(bench); }}};
}

std::vector<StressRow> input_rows(const SubjectPointer& subject) {
  return {{"S20", subject->name, "an unknown key in each of its objects", "keys that are not named", "", true,
           [subject] { return with_unknown_keys(*subject); }},
          {"S20", subject->name, "null for each of its values", "values that are not named", "", true,
           [subject] { return with_nulls(*subject); }}};
}

}  // namespace coapt
