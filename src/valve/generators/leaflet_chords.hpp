// Chords where the image shows none: from papillary tips to any leaflet mesh with an annulus and a free edge.
#pragma once

#include "formats/valve.hpp"

#include <string>
#include <vector>

namespace coapt {

// Insertions along a line on the leaflets.
struct ChordZone {
  std::string material;  // of its chords
  double height = 1;     // 0 at the annulus, 1 at the free edge, by distances along mesh edges
  double area = 0.4;     // of a chord where it leaves the tip [mm^2]
};

// "free_edge" (material primary, height 1, 0.4 mm^2), "rough" (secondary, 0.65, 0.8 mm^2) or "basal"
// (tertiary, 0.25, 1.2 mm^2). Throws InputError for another name.
ChordZone chord_zone(const std::string& name);
std::vector<std::string> chord_zone_names();

// What the rest length of a chord is.
enum class ChordLengths {
  ToPlane,    // from the (closed) tip to where the vertex is expected on the annulus plane
  ToCoapted,  // the same, but the free edge is expected below, as the leaflets hang there where they meet
  Sum  // the vertex's distance from the plane and that from the tip, of the open valve: of straight chords
};

// By its name: coapted, plane or sum; throws InputError for any other.
ChordLengths chord_lengths(const std::string& name);

struct LeafletChordOptions {
  std::vector<ChordZone> zones = {ChordZone{"primary", 1, 0.4}};
  int count = 24;    // chords of each zone that leave the tips, over all tips together
  int levels = 1;    // 1: straight from tip to leaflet; 2: a trunk and its fan; 3: the branches fan again ...
  int branches = 3;  // of a chord at each branch point
  double scale = 1;  // on all rest lengths
  double depth = 0;  // how far below the annulus plane the insertions are expected in the closed valve [mm]
  std::vector<double> level_areas = {};  // of one chord at each level [mm^2]; empty: as the zone says, shared
                                         // out equally at each branch point
  ChordLengths lengths = ChordLengths::ToPlane;
  // Vertices at which straight chords end, in the place of zones and count: one group, or one for each tip.
  // Chords of the free edge are primary, those of the body secondary.
  std::vector<std::vector<int>> insertions = {};
  unsigned seed = 0;  // 0: insertions at equal steps; any other shifts each by up to a third of one
};

// The chords of the valve: its leaflets, annulus (annulus_closed where it is known), free edge, and
// chords.papillary (papillary_closed where they are known) are read, its chords are not. A valve without
// chords.papillary gets two tips (unseen_tips.hpp). mm.
//
// Source of the straight chords: Walczak et al. 2019, section 3.5. Sum is its rule; ToPlane, which knows
// where the closed tips are, is ours: a leaflet vertex is expected where it projects onto the closed annulus'
// best plane, `depth` below it; the rest length is `scale` times the distance from there to the closed
// papillary tip. With ToCoapted a vertex at the distance r from the free edge (along mesh edges) is expected
// H - r lower, if that is above 0. H is half of the area that the leaflets have more than the closed annulus
// encloses over the length of the free edge: the other half bulges. A branch point is expected at 0.55 of the
// way to the middle of the insertions that it serves, and rest lengths are `scale` times the distances
// between expected places. Rest lengths are never changed to fit the open valve: with a small scale chords
// may pull from the start. Junctions start where no chord pulls if there is such a place.
//
// Insertions lie at equal steps of the free edge's length (inside: at the zone's height, where a harmonic
// map of the edge goes on with that length), each at a vertex of its own; count x branches^(levels - 1) of
// each zone. Neighbours share a chord, which comes from the tip nearest to them. Deterministic.
//
// Throws InputError with all defects: options out of range, insertions that are no vertices, tips that are
// not finite, beyond kGreatestCoordinate, or on or above the plane, no annulus or free edge, fewer vertices
// than insertions.
ChordNetwork leaflet_chords(const Valve& valve, const LeafletChordOptions& options);

// Names the rims of a mesh from its boundary, as far as they are not named: the loop farthest from the tips
// is the annulus, without tips the one that encloses the greatest area, all boundary vertices off the annulus
// are the free edge. Throws InputError where there is no other loop for the free edge. Pre: as
// boundary_loops.
void find_rims(Valve& valve);

}  // namespace coapt
