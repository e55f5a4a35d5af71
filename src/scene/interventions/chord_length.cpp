// Chords made shorter or longer.
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "scene/interventions/chord_selection.hpp"

namespace coapt {
namespace {

double new_length(const Parameters& p, double length) {
  if (p.has("factor")) return length * p.number("factor");
  return p.has("by") ? length + p.number("by") : p.number("to");
}

void change_lengths(const InterventionSpec& spec, ValveEdit& valve) {
  const Parameters& p = spec.parameters;
  ChordNetwork& network = chosen_network(spec, valve.networks);
  const std::vector<size_t> chosen = selected_chords(spec, valve, network);
  std::vector<std::string> defects;
  for (const size_t k : chosen)
    if (!(new_length(p, network.chords[k].rest_length) > 0)) {
      defects.push_back(p.where("by") + ": " + chord_text(k) + " is only " +
                        number_text(network.chords[k].rest_length, 4) +
                        " mm long at rest; nothing would be left of it");
    }
  if (!defects.empty()) throw InputError(defects);
  for (const size_t k : chosen) network.chords[k].rest_length = new_length(p, network.chords[k].rest_length);
}

}  // namespace

InterventionType chord_length_intervention() {
  std::vector<KeySpec> keys = chord_selection_keys();
  keys.push_back({.name = "factor",
                  .min = 0,
                  .excludes_min = true,
                  .doc = "Times the rest length: below 1 shortens, above 1 lengthens."});
  keys.push_back({.name = "by",
                  .dimension = kLength,
                  .doc = "Added to the rest length: below 0 shortens, above 0 lengthens."});
  keys.push_back({.name = "to",
                  .dimension = kLength,
                  .min = 0,
                  .excludes_min = true,
                  .doc = "The rest length of each."});
  return {
      .name = "chord_length",
      .summary = "Chords get another rest length: chordal shortening, or one that is elongated.",
      .spec = {.keys = std::move(keys), .groups = {chord_selection_group(), {{"factor", "by", "to"}, true}}},
      .edit = change_lengths};
}

}  // namespace coapt
