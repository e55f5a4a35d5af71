// The middles of sheets that a volume shows, as points.
#pragma once

#include "image/segment/sheet_evidence.hpp"

namespace coapt {

// Where the strength of the evidence is greatest along the normal of its sheet, to a fraction of a voxel, and
// at least `least`: at most one point for each voxel, in their order. 3 x count [mm].
Points ridge_points(const SheetEvidence& evidence, double least);

// What a whole volume shows of sheets. Throws InputError as sheet_evidence() does.
Points ridge_points_in(const Volume& volume);

// What a volume shows of leaflets that hang from this annulus (3 x n) [mm]: ridge points in the part of the
// volume around it. Throws InputError as sheet_evidence() does.
Points ridge_points_around(const Volume& volume, const Points& annulus);

}  // namespace coapt
