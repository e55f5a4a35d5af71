#include "scene/interventions/chord_selection.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/json/suggestion.hpp"

#include <algorithm>
#include <set>

namespace coapt {
namespace {

using Kind = ChordEnd::Kind;

bool ends_at(const Chord& chord, Kind kind, const std::set<int>& indices) {
  return (chord.from.kind == kind && indices.contains(chord.from.index)) ||
         (chord.to.kind == kind && indices.contains(chord.to.index));
}

// The whole numbers of a key, each below `count`.
std::set<int> numbers(const Parameters& p, const char* key, Eigen::Index count, const char* what) {
  std::set<int> all;
  for (const double number : p.numbers(key)) {
    if (number >= static_cast<double>(count))
      throw InputError(p.where(key) + ": there is no " + what + " " + exact_text(number) +
                       "; the network has " + std::to_string(count) + ", counted from 0");
    all.insert(static_cast<int>(number));
  }
  return all;
}

std::set<std::string> materials_of(const ChordNetwork& network) {
  std::set<std::string> all;
  for (const Chord& chord : network.chords) all.insert(chord.material);
  return all;
}

}  // namespace

KeySpec network_key() {
  return {.name = "network",
          .kind = KeyKind::File,
          .choices = {kGeneratedNetwork},
          .doc = "The network that is meant, as terms name it; default: the only one."};
}

std::vector<KeySpec> chord_selection_keys() {
  return {
      network_key(),
      {.name = "chords",
       .kind = KeyKind::Integers,
       .min = 0,
       .doc = "Chords by their numbers in the network, counted from 0, as it is when the intervention is "
              "made."},
      {.name = "materials", .kind = KeyKind::Texts, .doc = "Chords of this material, or of these."},
      {.name = "ends", .kind = KeyKind::Nodes, .doc = "Chords that end at one of these leaflet vertices."},
      {.name = "tips",
       .kind = KeyKind::Integers,
       .min = 0,
       .doc = "Chords that start at these papillary tips, by number from 0."}};
}

KeyGroup chord_selection_group() { return {{"chords", "materials", "ends", "tips"}, false}; }

ChordNetwork& chosen_network(const InterventionSpec& spec, NamedNetworks& networks) {
  const Parameters& p = spec.parameters;
  if (networks.empty()) throw InputError(p.where() + ": the scene has no chords; no term names a network");
  if (!p.has("network")) {
    if (networks.size() == 1) return networks.front().second;
    std::vector<std::string> paths;
    for (const auto& [path, network] : networks) paths.push_back(path);
    throw InputError(p.where() + ": the scene has " + std::to_string(networks.size()) +
                     " networks; say which by `network`: " + listed(paths));
  }
  for (auto& [path, network] : networks)
    if (path == p.text("network")) return network;
  throw InputError(p.where("network") + ": no term names this network");
}

std::vector<size_t> selected_chords(const InterventionSpec& spec, const ValveEdit& edit,
                                    const ChordNetwork& network) {
  const Parameters& p = spec.parameters;
  std::set<int> wanted, ends, tips;
  std::set<std::string> materials;
  if (p.has("chords"))
    wanted = numbers(p, "chords", static_cast<Eigen::Index>(network.chords.size()), "chord");
  if (p.has("tips")) tips = numbers(p, "tips", network.papillary.cols(), "papillary tip");
  if (p.has("ends")) {
    const std::vector<int> vertices = edit.vertices(p.nodes("ends"), p.where("ends"));
    ends.insert(vertices.begin(), vertices.end());
  }
  if (p.has("materials")) materials.insert(p.texts("materials").begin(), p.texts("materials").end());
  std::vector<size_t> chosen;
  for (size_t k = 0; k < network.chords.size(); ++k) {
    const Chord& chord = network.chords[k];
    if (p.has("chords") && !wanted.contains(static_cast<int>(k))) continue;
    if (p.has("materials") && !materials.contains(chord.material)) continue;
    if (p.has("ends") && !ends_at(chord, Kind::Leaflet, ends)) continue;
    if (p.has("tips") && !ends_at(chord, Kind::Papillary, tips)) continue;
    chosen.push_back(k);
  }
  if (chosen.empty()) {
    const std::set<std::string> known = materials_of(network);
    throw InputError(p.where() + ": no chord is meant; the network has " +
                     std::to_string(network.chords.size()) + " chords, of the materials " +
                     listed(std::vector<std::string>(known.begin(), known.end())) +
                     (p.has("ends") ? "; chords end at leaflet vertices that the network names" : ""));
  }
  return chosen;
}

void remove_chords(ChordNetwork& network, const std::vector<size_t>& chords) {
  std::vector<bool> is_gone(network.chords.size(), false);
  for (const size_t chord : chords) is_gone[chord] = true;
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    std::vector<int> held(static_cast<size_t>(network.junctions.cols()), 0);
    const auto junctions = [&](const Chord& chord, const auto& visit) {
      for (const ChordEnd& end : {chord.from, chord.to})
        if (end.kind == Kind::Junction) visit(static_cast<size_t>(end.index));
    };
    for (size_t k = 0; k < network.chords.size(); ++k)
      if (!is_gone[k]) junctions(network.chords[k], [&](size_t junction) { ++held[junction]; });
    for (size_t k = 0; k < network.chords.size(); ++k) {
      if (is_gone[k]) continue;
      bool hangs = false;
      junctions(network.chords[k], [&](size_t junction) { hangs = hangs || held[junction] < 2; });
      if (hangs) is_gone[k] = has_changed = true;
    }
  }
  std::vector<Chord> left;
  for (size_t k = 0; k < network.chords.size(); ++k)
    if (!is_gone[k]) left.push_back(network.chords[k]);
  network.chords = std::move(left);
}

std::string chord_text(size_t chord) { return "chords[" + std::to_string(chord) + "]"; }

}  // namespace coapt
