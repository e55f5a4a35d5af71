// Smooth contact zone: how much of a surface lies against another part of it, and how high that zone is.
#pragma once

#include "sensitivity/metrics/metric.hpp"

#include <memory>

namespace coapt {

struct ContactZoneOptions {
  double range = 0;  // distance from which on a vertex does not count; it counts wholly below half of it

  // Of the height: how sharply the uppermost and lowermost places count [1/length].
  double sharpness = 2;
};

// The measure of contact of a vertex is psi(gap/range), gap its distance from the nearest facet none of whose
// corners is its neighbour, psi falling from 1 to 0 between 1/2 and 1 as a polynomial that is twice
// differentiable. Neighbours are the vertices within two edges or, at rest (X), within 1.5 times the range:
// what touches there is the sheet itself. Exact derivatives, but where two facets that share no edge are
// equally near to a vertex.
//
// Area of the surface in contact, both faces counted: sum of nodal areas times psi [length^2].
// Throws InputError for a range that is not positive, or a surface without triangles.
std::unique_ptr<Metric> make_contact_zone_area(std::string name, const Triangles& triangles, const Points& X,
                                               const ContactZoneOptions& options);

// Extent of that zone along a direction: smooth maximum minus smooth minimum, log(mean of exp(b z))/b + log
// (mean of exp(-b z))/b, means weighted as above [length]; 0 where nothing is in contact. Less than the
// greatest extent, by some logarithms over b. Throws InputError as above, for a direction of no length, and
// for a sharpness that is not positive.
std::unique_ptr<Metric> make_contact_zone_height(std::string name, const Triangles& triangles,
                                                 const Points& X, const Vec3& direction,
                                                 const ContactZoneOptions& options);

}  // namespace coapt
