// How far the closed shape on a mesh is from that on ever finer ones, as far as a sequence of meshes shows
// it, each the one before with every triangle cut into four.
#pragma once

#include "scene/reference_distance.hpp"

#include <optional>
#include <vector>

namespace coapt {

struct DiscretisationEstimate {
  // log2 of the ratio of the last two mean distances; empty where there are fewer than two, or one is zero.
  std::optional<double> order;
  // That distances beyond the last mesh are taken to fall with: the observed one, but at least 1/2 and at
  // most 2; 1 where none was observed.
  double assumed_order = 1;
  // Of each mesh: that 95 % of the surface are no farther from the limit [mm].
  std::vector<double> error_mm;
};

// to_next: between the shape on each mesh and that on the next finer one, at least one. The estimate has one
// mesh more: the error of the last is d / (2^p - 1), with the last distance d and the assumed order p, and
// that of another mesh the sum of the distances from it on and of the error of the last.
DiscretisationEstimate estimate_discretisation(const std::vector<DistanceFigures>& to_next);

}  // namespace coapt
