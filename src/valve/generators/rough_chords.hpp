// Branching trees of chords for a rough valve.
#pragma once

#include "formats/valve.hpp"
#include "valve/generators/rough_mesh.hpp"

namespace coapt {

inline constexpr double kMostSlack = 0.4;     // of a strand in the open valve, over its straight length
inline constexpr double kMostShortage = 0.1;  // of the few strands that are too short

// Trees as in rough_chord_plan.hpp, from the tips below each commissure to the halves of the two leaflets
// that meet there. A tip's strand ends at a branch point or, now and then, at a vertex; a strand has the
// cross-section of all that it bears. A vertex has five strands at most, each of another branch point; where
// the mesh is so coarse that more than 43 % as many strands as vertices were wanted, strands are left out.
//
// Rest lengths are those of the surface as closed by construction, a few percent longer, so that the leaflets
// can meet; of how the tips move they know nothing: on that way chords pull. Branch points start where
// strands are neither stretched nor slacker than kMostSlack if there is such a place, and lengths are cut to
// these limits; of the slack a valve has a share drawn from 0.3 to 1, and three in ten have none, as measured
// valves whose lengths are those of the open state. In three to ten fans of ten strands are exactly as long
// as in the open valve, and their trunk is as long as the farthest insertion asks for. One to six strands in
// a hundred are too short by up to kMostShortage. Strands are lengthened, within kMostSlack, where a vertex
// could not be reached in the closed valve. Plans are made on the surface: trees are about the same at every
// mesh size.
ChordNetwork rough_chords(const RoughSurface& surface, const RoughMesh& mesh, RandomSource& random);

}  // namespace coapt
