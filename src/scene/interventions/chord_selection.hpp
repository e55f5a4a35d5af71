// Which chords an intervention means. Private to this room.
#pragma once

#include "scene/interventions/intervention.hpp"

namespace coapt {

// Keys `network`, `chords`, `materials`, `ends` and `tips`; all that are given must hold.
std::vector<KeySpec> chord_selection_keys();
KeyGroup chord_selection_group();  // at least one of the last four

// The key `network` alone.
KeySpec network_key();

// The network that the key names, or the only one. Throws InputError, listing those there are.
ChordNetwork& chosen_network(const InterventionSpec& spec, NamedNetworks& networks);

// Numbers of the chords in the network, ascending. Throws InputError where a number does not exist or none is
// left.
std::vector<size_t> selected_chords(const InterventionSpec& spec, const ValveEdit& edit,
                                    const ChordNetwork& network);

// Takes chords out of the network, with those that then hang on a junction and hold nothing.
void remove_chords(ChordNetwork& network, const std::vector<size_t>& chords);

// What a message says of a chord: "chords[3]".
std::string chord_text(size_t chord);

}  // namespace coapt
