// What a surface leaves open of a polygon: the orifice of a valve seen along the normal of its annulus.
#pragma once

#include "core/types.hpp"

namespace coapt {

struct Plane {
  Vec3 centre;  // centroid of the points [length]
  Vec3 normal;  // unit; its component of largest size is positive
};

// The plane with the least sum of squared distances. Throws InputError for fewer than three points, or for
// points on one line.
Plane best_fit_plane(const Points& points);

struct UncoveredArea {
  double area = 0;          // inside the projected polygon, under no projected triangle [length^2]
  double polygon_area = 0;  // of the projected polygon [length^2]
  double error = 0;         // estimate for `area`: its change when the rows were last halved [length^2]
  double row_height = 0;    // of the highest row [length]: the resolution; along the rows lengths are exact
  int row_count = 0;
};

// Projects along `normal` and integrates over rows; in each, the intervals that the triangles cover are
// united exactly. Rows end where an edge runs along them. From 512 rows over the polygon's extent, they are
// halved one to five times (`refinement`: into so many at most), until `area` changes by less than 1e-6 of
// the polygon's area. The polygon is closed, given by its corners in order; its inside follows the even-odd
// rule. Throws InputError when the polygon has fewer than three corners or its projection no area, or when
// the normal is zero. Pre: positions are finite, corner indices in range.
UncoveredArea uncovered_area(const Points& points, const Triangles& triangles, const Points& polygon,
                             const Vec3& normal, int refinement = 32);

// The derivatives of that area by what it is made of, with the view held; of a size with each [length].
struct UncoveredAreaGradient {
  Points by_points, by_polygon;
};

// Summed over rows as the area is, of how the ends of what is uncovered move in each; once over rows as they
// are there and once across, so that each edge is met by rows that it is at more than 45 degrees to. Pre and
// throws: as above.
UncoveredAreaGradient uncovered_area_gradient(const Points& points, const Triangles& triangles,
                                              const Points& polygon, const Vec3& normal);

}  // namespace coapt
