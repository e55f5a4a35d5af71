// Continuous collision detection: how far two pieces of surface may move, each corner on a straight line,
// before they come too near. Never too far.
//
// Method: conservative advancement (Mirtich: Impulse-based dynamic simulation, 1996) in the additive form of
// Li, Kaufman, Jiang (Codimensional incremental potential contact, ACM Trans. Graph. 40, 2021), with a
// sharper bound. A plane between the two sides, normal to the line between their closest points, keeps every
// pair of corners apart for as long as a linear function of the step says. The pair is moved that far, the
// closest points are found anew. The bound with norms of displacements, which the paper uses, follows from
// this one and is never longer.
//
// Guarantee, in floating point: at every step in [0, s] the distance, also that of the rounded positions x +
// s d, is at least kept times the present one, hence positive. It rests on nothing but the signs of these
// linear functions, evaluated with a margin of 4e-15 times the norm of all coordinates; badly conditioned
// closest points can only make the step shorter, which they may where the distance is below 1e-8 of the
// pair's extent.
#pragma once

#include "mesh/distance/pair_corners.hpp"

namespace coapt {

// A step s in [0, most] such that the pair moving from x to x + s d keeps at least the share `kept` of its
// present distance all along; near the greatest such step. 0 where the pair touches already, or is closer
// than rounding can tell, and for positions or displacements that are not finite. The least step of many
// pairs comes soonest when each is asked with `most` = the least so far. Pre: 0 <= most < infinity, 0 <= kept
// < 1.
double point_triangle_step(const PairCorners& x, const PairCorners& d, double most, double kept);
double edge_edge_step(const PairCorners& x, const PairCorners& d, double most, double kept);

}  // namespace coapt
