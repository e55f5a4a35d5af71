// Where chords end on the leaflets.
#pragma once

#include "valve/generators/leaflet_chords.hpp"

#include <vector>

namespace coapt {

// A chord and the vertices that it serves; more than one where it branches.
struct PlannedChord {
  ChordZone zone;
  std::vector<int> vertices;
  int tip = -1;  // -1: not said
};

// Those of the options' insertions, each with a chord of its own, or else at equal steps in each zone. Throws
// InputError with all defects: insertions that are no vertex, on the annulus or named twice, fewer vertices
// than insertions. Pre: the rims are named.
std::vector<PlannedChord> planned_chords(const Valve& valve, const LeafletChordOptions& options);

}  // namespace coapt
