// The outlines of what a surface leaves open of a polygon: the orifices of a valve.
#pragma once

#include "mesh/top_view.hpp"

#include <vector>

namespace coapt {

struct Outline {
  Points corners;          // closed, in space; each on the rim that ends the open area there [length]
  double area = 0;         // seen from above; negative: a covered island within an open area [length^2]
  double perimeter = 0;    // in space [length]
  double mean_height = 0;  // of the rim above the frame's centre, weighted by its length [length]
  int open_node = 0;       // a node of the view beside it, in the open area
};

// Corners lie where the grid lines of the view cross the rims, exactly; between them the outline is straight,
// so that area and perimeter are accurate to second order in the cell. Open places that meet only across
// the corner of a cell are told apart. In ascending order of their lowest, leftmost crossing.
std::vector<Outline> open_outlines(const TopView& view);

}  // namespace coapt
