// Papillary tips where no image shows them.
#pragma once

#include "mesh/projected_area.hpp"
#include "valve/generators/chord_insertions.hpp"

namespace coapt {

// Two tips, and for each chord which is its. Source: Walczak et al. 2019, section 3.5: the insertions are
// divided into two halves, each with about half of both leaflets; with the centroid c of those of a half, d
// below the annulus plane, its tip is at c - d normal, 2 d below. The halves are those that the chords name;
// where they name none (ours): on either side of the median along the line through the commissures, or
// through the longest diameter of the annulus where the valve names no commissures. plane: of the annulus,
// its normal away from the leaflets. Throws InputError where a half is empty or its centroid is not below the
// plane.
Points unseen_tips(const Valve& valve, const Plane& plane, std::vector<PlannedChord>& chords);

}  // namespace coapt
