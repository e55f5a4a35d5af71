// Branching trees of chords for a rough valve.
#pragma once

#include "mesh/generators/rough_mesh.hpp"
#include "mesh/valve.hpp"

namespace coapt {

inline constexpr double kMostSlack = 0.4;     // of a strand in the open valve, over its straight length
inline constexpr double kMostShortage = 0.1;  // of the few strands that are too short

// From the tips below each commissure to the halves of the two leaflets that meet there: to the margin every
// 0.8 to 4.5 mm ("primary") and to the belly ("secondary"). A tip's strand ends at a branch point or, now and
// then, at a vertex; a branch point serves two to ten insertions or two further branch points. A vertex
// has one strand at most, and a strand the cross-section of all that it bears.
//
// Rest lengths are those of the surface as closed by construction, a few percent longer, so that the leaflets
// can meet, with tips that have made a share of their way drawn from 0 to 1: on the rest of it chords pull;
// branch points start where strands are neither stretched nor slacker than kMostSlack if there is such a
// place, and lengths are cut to these limits. One strand in twenty-five is too short by up to kMostShortage,
// but none so that its vertex could not be reached in the closed valve.
// Plans are made on the surface: trees are about the same at every mesh size.
ChordNetwork rough_chords(const RoughSurface& surface, const RoughMesh& mesh, RandomSource& random);

}  // namespace coapt
