// How far a solved surface lies from a given closed one.
#pragma once

#include "results/fields.hpp"

#include <optional>

namespace coapt {

struct DistanceFigures {
  double mean = 0, p95 = 0, max = 0;  // [mm]
};

struct VertexDistance {
  double mean = 0, max = 0;  // [mm]
};

struct ReferenceDistance {
  DistanceFigures to_reference;               // from the solved surface to the reference
  DistanceFigures from_reference;             // from the reference to the solved surface
  std::optional<VertexDistance> same_vertex;  // when both have the same facets, in any order
};

// Both directions together: the mean of the means, the greater percentile and maximum.
DistanceFigures both_directions(const ReferenceDistance& distance);

// The same between any two surfaces. Throws InputError when one of them has no area.
DistanceFigures distance_between(const TriangleMesh& a, const TriangleMesh& b);

// From one surface to another and back; `vertex_distances` gets the distance of every vertex of `closed` to
// the closest point of `reference` [mm]. Throws InputError when one of them has no area.
ReferenceDistance reference_distance(const TriangleMesh& closed, const TriangleMesh& reference,
                                     Vector& vertex_distances);

// The model's surface with its nodes at x (3 x node_count, relative to the origin).
TriangleMesh surface_at(const Model& model, const Points& x);

// Nothing for a model without a closed reference. Also fills fields.reference_distance.
std::optional<ReferenceDistance> compare_with_reference(const Model& model, Fields& fields);

}  // namespace coapt
