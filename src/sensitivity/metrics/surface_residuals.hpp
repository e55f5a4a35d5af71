// The distance of a surface from a target, as residuals of a least-squares fit.
#pragma once

#include "mesh/triangle_mesh.hpp"
#include "sensitivity/metrics/residual_set.hpp"

#include <memory>

namespace coapt {

// Whose vertices look for the other surface. From the surface alone, a target may be larger than it; from the
// target alone, a target may be a part of it. An edge of the surface that ends short of the target's is seen
// from the target only, one that ends beyond from the surface only.
enum class FitSides { Both, Surface, Target };

// Three for each vertex of `triangles`, ascending, then three for each vertex of the target: the vector to it
// from the closest point of the other surface, times the root of its share of the area, at x_weights (3 x
// node_count) or of the target. Their squares add up to the mean square distance [length^2], of both sides
// to the mean of the two.
//
// Unlike the rounded distances of make_distance_residuals(), whose derivatives vanish on the target, they
// tell also there what a motion changes: across a facet alone, across an edge of the surface in two
// directions, at a corner in all. Exact derivatives, the turning of the facets included, but where two
// points are equally close.
//
// Where two sheets lie against each other the nearest point may belong to the wrong one: only facets that
// face as the surface does around the vertex count, unless there are none within some times the distance of
// the nearest. The target as a whole may face either way; that which fits at x_weights is taken. Throws
// InputError for a target or a surface without area, and for a vertex of the target that is not finite.
std::unique_ptr<MeasuredResiduals> make_surface_residuals(const Triangles& triangles, const Points& x_weights,
                                                          const TriangleMesh& target,
                                                          FitSides sides = FitSides::Both);

}  // namespace coapt
