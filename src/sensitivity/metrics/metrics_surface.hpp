// How far a surface is from a target.
#pragma once

#include "mesh/triangle_mesh.hpp"
#include "sensitivity/metrics/metric.hpp"

#include <memory>
#include <vector>

namespace coapt {

struct SurfaceDistanceOptions {
  // Distances d enter as sqrt(d^2 + rounding^2) - rounding, so that a vertex may lie on the target [length].
  double rounding = 1e-3;

  // 0: the mean. Above: the smooth maximum log(mean of exp(sharpness d)) / sharpness, which is never above
  // the greatest distance and at most log(1/share)/sharpness below, share being the weight of the farthest
  // vertex [1/length].
  double sharpness = 0;
};

// Of the vertices of a surface from the closest points of the target, unsigned [length]. Vertices weigh a
// third of the triangles around them at x_weights (3 x node_count), which stays: mean over the surface as it
// was. Exact derivatives but where two points of the target are equally close (its medial surface).
// Throws InputError for a target or a surface without area and options out of range.
std::unique_ptr<Metric> make_surface_distance(std::string name, const Triangles& triangles,
                                              const Points& x_weights, const TriangleMesh& target,
                                              const SurfaceDistanceOptions& options = {});

// The rounded distance of each vertex by itself: residuals of a least-squares fit, times the root of its
// share of the weight, so that their squares add up to the mean square. Vertices of `triangles`, ascending.
std::vector<std::unique_ptr<Metric>> make_distance_residuals(const std::string& name,
                                                             const Triangles& triangles,
                                                             const Points& x_weights,
                                                             const TriangleMesh& target, double rounding);

}  // namespace coapt
