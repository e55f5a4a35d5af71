// Where prescribed nodes are held, as a parameter: papillary tips, an annulus, a ring.
#pragma once

#include "energy/objective.hpp"
#include "sensitivity/parameters/parameter.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace coapt {

// Places of the nodes for a value (3 x number of nodes) and, where `slopes` is not null, their derivatives by
// each number of it, one array per number.
using PositionMap = std::function<Points(const Vector& value, std::vector<Points>* slopes)>;

// nodes: each prescribed in all three coordinates. The map is called with `value` at once. Throws InputError,
// all defects in one pass: a node out of range or not prescribed, and a map whose result has the wrong shape
// or is not finite.
std::unique_ptr<Parameter> make_prescribed_positions(std::string name, const Objective& objective,
                                                     std::vector<int> nodes, PositionMap map,
                                                     const Vector& value);

// --- maps; the points are where the nodes are for the value that is given with each [length] --------------
// Each coordinate of each point by itself; value: the coordinates, point after point.
PositionMap free_positions();
Vector coordinates(const Points& points);

// All points moved alike; value: the displacement, zero at first [length].
PositionMap shifted(const Points& points);

// A ring about its centre: u along `across`, v along the other direction in the plane, w along `axis`.
//   value: factor on u, factor on v, factor on w (the height of the saddle), tilt about the direction of u
//          [rad]; first (1, 1, 1, 0)
// axis and across need not be unit vectors. Throws InputError when they are parallel, zero or not finite.
PositionMap ring_shape(const Points& points, const Vec3& axis, const Vec3& across);
Vector unchanged_ring();

}  // namespace coapt
