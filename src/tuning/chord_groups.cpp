#include "tuning/chord_groups.hpp"

#include "core/error.hpp"
#include "formats/json/json_text.hpp"
#include "formats/json/read_json.hpp"
#include "formats/json/suggestion.hpp"
#include "scene/file/scene_text.hpp"
#include "scene/terms/term_types.hpp"
#include "sensitivity/parameters/joint_parameter.hpp"
#include "sensitivity/parameters/line_lengths.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace coapt {
namespace {

namespace fs = std::filesystem;

constexpr double kSame = 1e-9;
constexpr const char *kNoTip = "no tip", *kNoMaterial = "no material";

// The papillary tip of each chord: breadth first from the tips, so that the nearest counts.
std::vector<int> tips_of(const ChordNetwork& network) {
  std::vector<int> tip(network.chords.size(), -1),
      of_junction(static_cast<size_t>(network.junctions.cols()), -1);
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    std::vector<std::pair<size_t, int>> reached;
    for (size_t k = 0; k < network.chords.size(); ++k) {
      if (tip[k] >= 0) continue;
      for (const ChordEnd& end : {network.chords[k].from, network.chords[k].to}) {
        if (end.kind == ChordEnd::Kind::Papillary) tip[k] = end.index;
        if (end.kind == ChordEnd::Kind::Junction && tip[k] < 0)
          tip[k] = of_junction[static_cast<size_t>(end.index)];
      }
      if (tip[k] < 0) continue;
      has_changed = true;
      for (const ChordEnd& end : {network.chords[k].from, network.chords[k].to})
        if (end.kind == ChordEnd::Kind::Junction)
          reached.emplace_back(static_cast<size_t>(end.index), tip[k]);
    }
    for (const auto& [junction, of] : reached)
      if (of_junction[junction] < 0) of_junction[junction] = of;
  }
  return tip;
}

std::string or_none(const std::string& name, const char* none) { return name.empty() ? none : name; }

// Every name of a chord by which it may be asked for, by grouping.
std::vector<std::string> names_of(const TunableChord& chord, const Model& model, ChordGrouping grouping,
                                  bool has_networks) {
  switch (grouping) {
    case ChordGrouping::Chord:
      return {(has_networks ? chord.network + ": " : std::string()) + "chords[" +
              std::to_string(chord.number) + "]"};
    case ChordGrouping::Tip:
      return {chord.tip < 0 ? kNoTip : "tip_" + std::to_string(chord.tip)};
    case ChordGrouping::Material:
      return {or_none(chord.material, kNoMaterial)};
    case ChordGrouping::Term: {
      std::vector<std::string> terms;
      for (const size_t line : chord.lines)
        if (terms.empty() || terms.back() != model.lines[line].term) terms.push_back(model.lines[line].term);
      return terms;
    }
    case ChordGrouping::All:
      return {"all"};
  }
  return {};
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : " and ") + name;
  return text;
}

bool has_networks(const std::vector<TunableChord>& chords) {
  return std::any_of(chords.begin(), chords.end(),
                     [&](const TunableChord& chord) { return chord.network != chords.front().network; });
}

// Texts that name files from `from`, as they are named from `to`.
void move_paths(Json& json, const fs::path& from, const fs::path& to) {
  if (json.is_structured()) {
    for (Json& item : json) move_paths(item, from, to);
  } else if (json.is_string()) {
    const fs::path named = json.get_ref<const std::string&>();
    std::error_code error;
    if (named.empty() || named.is_absolute() || !fs::is_regular_file(from / named, error)) return;
    const fs::path moved = fs::relative(from / named, to, error);
    json = (error || moved.empty() ? fs::absolute(from / named) : moved).generic_string();
  }
}

}  // namespace

std::vector<TunableChord> tunable_chords(const Scene& scene, const SceneGeometry& geometry,
                                         const Model& model) {
  std::vector<TunableChord> all;
  for (const auto& [path, placed] : geometry.networks) {
    const std::vector<int> tips = tips_of(placed.network);
    std::vector<TunableChord> chords;
    for (size_t k = 0; k < placed.network.chords.size(); ++k)
      chords.push_back({path, k, placed.network.chords[k].material, tips[k]});
    for (const TermSpec& term : scene.terms) {
      const Parameters& p = term.parameters;
      if (!p.has("network") || p.text("network") != path || !p.has("length_scale")) continue;
      const bool has_lengths = std::all_of(model.lines.begin(), model.lines.end(), [&](const Line& each) {
        return each.term != term.name || each.rest_length > 0;
      });
      if (!has_lengths) continue;
      // Lines stand in the order of their chords; some chords have none.
      size_t line = 0;
      while (line < model.lines.size() && model.lines[line].term != term.name) ++line;
      for (size_t k = 0; k < chords.size() && line < model.lines.size(); ++k) {
        const Chord& chord = placed.network.chords[k];
        const Line& at = model.lines[line];
        if (at.term != term.name) break;
        if (!takes_material(p, chord.material) || at.a != placed.node(chord.from) ||
            at.b != placed.node(chord.to))
          continue;
        const double length = chord.rest_length * p.number("length_scale");
        if (length > 0 && std::abs(at.rest_length - length) <= kSame * length) {
          chords[k].lines.push_back(line);
          if (chords[k].length == 0) chords[k].length = at.rest_length;
        }
        ++line;
      }
    }
    for (TunableChord& chord : chords)
      if (!chord.lines.empty()) all.push_back(std::move(chord));
  }
  return all;
}

std::vector<ChordGroup> chord_groups(const std::vector<TunableChord>& chords, const Model& model,
                                     ChordGrouping grouping, const std::vector<std::string>& only) {
  const bool several = has_networks(chords);
  std::vector<bool> is_wanted(chords.size(), only.empty());
  std::set<std::string> known;
  std::vector<bool> is_found(only.size(), false);
  for (size_t k = 0; k < chords.size(); ++k)
    for (const ChordGrouping each : {ChordGrouping::Chord, ChordGrouping::Tip, ChordGrouping::Material,
                                     ChordGrouping::Term, ChordGrouping::All})
      for (const std::string& name : names_of(chords[k], model, each, several)) {
        if (each != ChordGrouping::Chord) known.insert(name);
        for (size_t i = 0; i < only.size(); ++i)
          if (only[i] == name) is_found[i] = is_wanted[k] = true;
      }
  std::vector<std::string> defects;
  const std::vector<std::string> names(known.begin(), known.end());
  for (size_t i = 0; i < only.size(); ++i)
    if (!is_found[i])
      defects.push_back("--only: no chord is called \"" + only[i] + "\"" + suggestion(only[i], names) +
                        "; there are: " + listed(names) + ", and single chords as in chords[0]");
  if (!defects.empty()) throw InputError(std::move(defects));

  std::vector<ChordGroup> groups;
  for (size_t k = 0; k < chords.size(); ++k) {
    if (!is_wanted[k]) continue;
    const std::string name = joined(names_of(chords[k], model, grouping, several));
    auto group =
        std::find_if(groups.begin(), groups.end(), [&](const ChordGroup& g) { return g.name == name; });
    if (group == groups.end()) group = groups.insert(groups.end(), ChordGroup{name, {}});
    group->chords.push_back(k);
  }
  for (ChordGroup& group : groups) {
    for (const size_t k : group.chords) group.length += chords[k].length;
    group.length /= static_cast<double>(group.chords.size());
  }
  return groups;
}

NamedChords named_chords(const Scene& scene, const SceneGeometry& geometry, const Model& model) {
  NamedChords named{tunable_chords(scene, geometry, model), {}};
  for (const ChordGrouping grouping : {ChordGrouping::Tip, ChordGrouping::Material})
    for (ChordGroup& group : chord_groups(named.chords, model, grouping, {}))
      if (group.name != kNoTip && group.name != kNoMaterial) named.groups.push_back(std::move(group));
  return named;
}

std::unique_ptr<Parameter> make_group_factors(std::string name, const std::vector<TunableChord>& chords,
                                              const std::vector<ChordGroup>& groups, const Model& model) {
  std::vector<JointPart> parts;
  for (const auto& term : model.objective->terms()) {
    std::vector<std::vector<int>> elements;
    JointPart part;
    for (size_t g = 0; g < groups.size(); ++g) {
      std::vector<int> own;
      for (const size_t k : groups[g].chords)
        for (const size_t line : chords[k].lines)
          if (model.lines[line].term == term->name()) own.push_back(model.lines[line].element);
      if (own.empty()) continue;
      elements.push_back(std::move(own));
      part.numbers.push_back(static_cast<int>(g));
    }
    if (elements.empty()) continue;
    part.parameter =
        make_line_lengths(term->name() + ".factors", *term, std::move(elements), LengthMeasure::Factor);
    parts.push_back(std::move(part));
  }
  return make_joint_parameter(std::move(name), static_cast<int>(groups.size()), std::move(parts));
}

std::string tuned_scene_text(const std::string& text, const fs::path& scene, const fs::path& folder,
                             const std::vector<TunableChord>& chords, const std::vector<ChordGroup>& groups,
                             const Vector& factors) {
  const bool several = has_networks(chords);
  const fs::path from = fs::absolute(scene).parent_path(), to = fs::absolute(folder);
  std::vector<std::string> edits;
  for (size_t g = 0; g < groups.size(); ++g) {
    const double factor = factors[static_cast<Eigen::Index>(g)];
    if (factor == 1) continue;
    std::map<std::string, std::vector<size_t>> numbers;  // by network
    for (const size_t k : groups[g].chords) numbers[chords[k].network].push_back(chords[k].number);
    for (const auto& [network, of_network] : numbers) {
      nlohmann::ordered_json edit = {{"type", "chord_length"}};
      if (several)
        edit["network"] =
            network == kGeneratedNetwork ? network : fs::relative(network, from).generic_string();
      edit["chords"] = of_network;
      edit["factor"] = factor;
      edits.push_back(json_text(edit));
    }
  }
  Json json =
      parse_json(edits.empty() ? text : with_interventions(text, edits, scene.string()), scene.string());
  json.erase("output");
  move_paths(json, from, to);
  return json_text(json, 2) + "\n";
}

}  // namespace coapt
