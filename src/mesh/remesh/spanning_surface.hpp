// A smooth surface spanned by a closed polygon in space, as heights over a plane: what a saddle-shaped
// annulus would hold if there were no leaflets.
#pragma once

#include "core/types.hpp"

#include <vector>

namespace coapt {

// Height of the polygon's interpolant at a place, by mean value coordinates: it agrees with the polygon on
// its edges, is smooth inside and reproduces a plane exactly. Source: Hormann and Floater, Mean value
// coordinates for arbitrary planar polygons, 2006. polygon: 3 x count, the third row holding heights.
// O(count).
double spanned_height(const Points& polygon, double x, double y);

// Height of the highest straight line through the place from one side of the polygon to the other; of the
// mean value coordinates this is the highest of what they average. 90 directions are tried. -infinity where
// no line reaches the polygon on both sides, as for places outside of it.
double highest_chord(const Points& polygon, double x, double y);

// The first, interpolated on a grid of 64 x 64 cells over the polygon's bounding box, for many places.
class SpanningSurface {
 public:
  // Pre: at least three corners whose bounding box has an area.
  explicit SpanningSurface(const Points& polygon);

  // Places beyond the bounding box get the height at the nearest place of it.
  double height(double x, double y) const;

 private:
  double x0_, y0_, dx_, dy_;
  std::vector<double> nodes_;
};

}  // namespace coapt
