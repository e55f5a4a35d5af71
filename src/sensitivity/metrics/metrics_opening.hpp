// Smooth area of the opening that is seen along an axis.
#pragma once

#include "sensitivity/metrics/metric.hpp"

#include <memory>
#include <vector>

namespace coapt {

struct OpeningOptions {
  Vec3 axis = Vec3::UnitZ();  // of the view: fixed
  double blur = 1;  // radius over which edges are blurred [length]; narrower slits count in part, or
                    // not at all
};

// Along the axis the surface covers a place y by m(y), the sum over its facets of their projected areas
// blurred with a kernel (1 - (r/blur)^2)^3, so that 1 means one sheet; the rim counts as a(y), 1 inside
// and 0 outside, blurred alike. The opening is the integral of phi(a - m) on a fixed grid, phi rising from 0
// to 1 between 1/4 and 3/4: a straight edge neither gains nor loses area, what is covered once or more often
// counts nothing [length^2]. Facets upright to the view cover nothing. Exact derivatives of that integral.
// triangles: the whole surface; rim: its nodes in order. x_start (3 x node_count) sets the grid, three points
// to a blur, around the rim with 20 % to spare, and how finely facets are sampled.
// Throws InputError for a rim of fewer than three nodes or without extent across the axis, and options
// out of range.
std::unique_ptr<Metric> make_opening_area(std::string name, const Triangles& triangles, std::vector<int> rim,
                                          const Points& x_start, const OpeningOptions& options = {});

}  // namespace coapt
