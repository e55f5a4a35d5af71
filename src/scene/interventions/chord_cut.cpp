// Chords that are cut, or ruptured.
#include "core/error.hpp"
#include "scene/interventions/chord_selection.hpp"

#include <utility>

namespace coapt {
namespace {

void cut_chords(const InterventionSpec& spec, ValveEdit& valve) {
  ChordNetwork& network = chosen_network(spec, valve.networks);
  ChordNetwork cut = network;
  remove_chords(cut, selected_chords(spec, valve, network));
  if (cut.chords.empty())
    throw InputError(spec.parameters.where() +
                     ": no chord would be left; leave some, or take the term of the chords out of the scene");
  network = std::move(cut);
}

}  // namespace

InterventionType chord_cut_intervention() {
  return {.name = "chord_cut",
          .summary =
              "Chords are taken out, as a surgeon cuts secondary chords or as one ruptures; pieces that "
              "then hang on a branch point and hold nothing go with them.",
          .spec = {.keys = chord_selection_keys(), .groups = {chord_selection_group()}},
          .edit = cut_chords};
}

}  // namespace coapt
