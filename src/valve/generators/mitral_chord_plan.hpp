// Which chords a generated mitral valve has.
#pragma once

#include "valve/generators/mitral_shape.hpp"

#include <string>
#include <vector>

namespace coapt {

// A point of the smooth shape.
struct ChordInsertion {
  double u, t;
};

// One chord: a trunk and its fan of branches.
struct ChordFan {
  std::string material;  // "primary", "secondary" or "strut"
  double area = 0;       // of the trunk [mm^2]
  std::vector<ChordInsertion> insertions;
};

// The twelve chords of one muscle (0 anterolateral, 1 posteromedial), as dimensions.chords says:
//   Even       3 primary, a secondary and a strut to the muscle's half of the anterior leaflet, 4 primary and
//              2 secondary to its half of the posterior leaflet, one to its commissure
//   RoughZone  4 primary and a strut to the anterior half, 5 primary and a secondary to the posterior half,
//   one
//              to its commissure; a primary one ends at `branches` points of the free edge and at `branches`
//              - 1 beside the line of coaptation (Lam et al. 1970)
// Pre: 2 <= branches <= 5.
std::vector<ChordFan> mitral_chord_plan(const MitralShape& shape, int muscle, int branches);

}  // namespace coapt
