// How far a solved surface lies from a given closed one.
#pragma once

#include "mesh/distance/surface_distance.hpp"
#include "registration/registration.hpp"
#include "results/closure.hpp"
#include "results/reference/coaptation_line.hpp"

#include <optional>
#include <vector>

namespace coapt {

struct VertexDistance {
  double mean = 0, max = 0;  // [mm]
};

// How the reference was brought onto the solved surface before its distance was taken.
struct AppliedRegistration {
  Registration found;         // its motion acts on the coordinates of the scene's files, in mm
  double translation_mm = 0;  // of the middle of the reference's vertices
  DistanceFigures to_reference_before, from_reference_before;
};

struct ReferenceDistance {
  DistanceFigures to_reference;               // from the solved surface to the reference
  DistanceFigures from_reference;             // from the reference to the solved surface
  std::optional<VertexDistance> same_vertex;  // when both have the same facets, in any order
  int left_out = 0;  // vertices whose place is not determined, and which have no part in these figures
  std::optional<AppliedRegistration> registration = {};  // none: the reference lies as it was given
  std::vector<std::string> doubts = {};                  // about the registration, whole sentences
  // From the coaptation line to that of the reference, and back; none where one of them is not seen.
  std::optional<LineDistance> lines = {};
};

// Both directions together: the mean of the means, the greater percentile and maximum.
DistanceFigures both_directions(const DistanceFigures& to, const DistanceFigures& from);
DistanceFigures both_directions(const ReferenceDistance& distance);

// The same between any two surfaces. Throws InputError when one of them has no area.
DistanceFigures distance_between(const TriangleMesh& a, const TriangleMesh& b);

// From one surface to another and back; `vertex_distances` gets the distance of every vertex of `closed` to
// the closest point of `reference` [mm], also of the uncounted ones. Figures that nothing is left for are
// NaN. Throws InputError when one of them has no area.
ReferenceDistance reference_distance(const TriangleMesh& closed, const TriangleMesh& reference,
                                     Vector& vertex_distances, const UncountedVertices& uncounted = {});

// The model's surface with its nodes at x (3 x node_count, relative to the origin).
TriangleMesh surface_at(const Model& model, const Points& x);

// Nothing for a model without a closed reference. That is registered first, where the scene says so; where
// that fails it stays as it lies, and a doubt says why. Also fills fields.reference_distance and what fields
// hold of a registered reference. free_nodes: that the certificate found to move at no cost; they are left
// out. closure: of the solved shape, whose coaptation line is compared too.
std::optional<ReferenceDistance> compare_with_reference(const Model& model, Fields& fields,
                                                        const std::vector<int>& free_nodes = {},
                                                        const std::optional<Closure>& closure = std::nullopt);

// The mean and the greatest distance of points of the same number; NaN where all are left out, by number in
// ascending order, and 0 where there are none. Pre: as many in both.
VertexDistance apart(const Points& a, const Points& b, const std::vector<int>& left_out = {});

// The numbers below `count` that are in one of two ascending lists.
std::vector<int> either_of(const std::vector<int>& a, const std::vector<int>& b, Eigen::Index count);

}  // namespace coapt
