// Where the branch point of a chord may hang before anything is solved.
#pragma once

#include "mesh/projected_area.hpp"

#include <vector>

namespace coapt {

// Of the way from the end nearer to the papillary tip to the middle of the insertions, in the closed valve.
inline constexpr double kJunctionPlace = 0.55;

// The limits on the start position of a junction: no chord that ends there longer than its rest length, and
// the junction at least a clearance on the ventricular side of some planes.
struct JunctionLimits {
  Points ends = Points(3, 0);        // [mm]
  std::vector<double> rest_lengths;  // of the chord to each end [mm]
  std::vector<Plane> planes;         // normals to the ventricle
};

// `start`, projected onto one limit after the other; the balls come last, so that chords stay slack when
// the limits exclude each other. All limits are convex: the sweeps converge to a common point if there is
// one.
Vec3 place_junction(Vec3 start, const JunctionLimits& limits);

// The papillary tip nearest to a point, of those from `first` to `last` - 1. Pre: there is one.
int nearest_tip(const Points& tips, int first, int last, const Vec3& point);

}  // namespace coapt
