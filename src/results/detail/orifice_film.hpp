// The film that closes an orifice. Private to this room.
#pragma once

#include "mesh/top_view.hpp"

#include <vector>

namespace coapt {

// Area of the surface of least area over the given open nodes of a view, held along their rim at the heights
// of the covered nodes beside them (4 neighbours) [length^2]: at least that of the nodes, as the film stands
// at an angle wherever its rim does. height: per node of the view, finite beside the given ones or at them
// not at all. To first order in the cell. Method: the graph of least area, div(grad u / sqrt(1 + |grad u|^2))
// = 0, by repeated linear solves whose weights are those of the film before (Concus 1967, Numerical solution
// of the minimal surface equation).
double film_area(const TopView& view, const std::vector<double>& height, const std::vector<int>& nodes);

}  // namespace coapt
