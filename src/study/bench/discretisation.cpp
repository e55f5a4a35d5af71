#include "study/bench/discretisation.hpp"

#include "mesh/remesh/uniform_refinement.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

DistanceFigures between(TriangleMesh coarser, size_t cuts, const TriangleMesh& finer) {
  for (size_t k = 0; k < cuts; ++k) coarser = refined_uniformly(coarser).mesh;
  return distance_between(coarser, finer);
}

}  // namespace

MeshDistances distances_between_meshes(const std::vector<TriangleMesh>& shapes) {
  MeshDistances distances;
  const size_t last = shapes.size() - 1;
  for (size_t k = 0; k < last; ++k) {
    distances.to_next.push_back(between(shapes[k], 1, shapes[k + 1]));
    distances.to_finest.push_back(k + 1 == last ? distances.to_next.back()
                                                : between(shapes[k], last - k, shapes[last]));
  }
  return distances;
}

std::optional<double> observed_order(const DistanceFigures& coarser, const DistanceFigures& finer) {
  if (!(coarser.mean > 0 && finer.mean > 0)) return std::nullopt;
  return std::log2(coarser.mean / finer.mean);
}

bool orders_agree(const MeshDistances& distances) {
  constexpr double kLeastOrder = 0.5, kApart = 0.5;
  const std::vector<DistanceFigures>& d = distances.to_next;
  if (d.size() < 3) return false;
  const auto before = observed_order(d[d.size() - 3], d[d.size() - 2]),
             last = observed_order(d[d.size() - 2], d[d.size() - 1]);
  return before && last && std::min(*before, *last) >= kLeastOrder && std::abs(*before - *last) <= kApart;
}

DiscretisationEstimate estimate_discretisation(const MeshDistances& distances) {
  const std::vector<DistanceFigures>&to_next = distances.to_next, &to_finest = distances.to_finest;
  DiscretisationEstimate estimate;
  const size_t last = to_next.size();  // of the meshes
  if (last > 1) estimate.order = observed_order(to_next[last - 2], to_next[last - 1]);
  if (estimate.order) estimate.assumed_order = std::clamp(*estimate.order, 0.5, 2.0);
  const double fall = std::exp2(-estimate.assumed_order);

  for (size_t k = 0; k + 1 < last; ++k)
    estimate.error_mm.push_back(to_finest[k].p95 / (1 - std::pow(fall, last - k)));
  double of_distance = 1 / (1 - fall);
  if (last > 1 && to_next[last - 2].p95 > 0)
    of_distance = std::clamp(estimate.error_mm.back() / to_next[last - 2].p95, 1.0, of_distance);
  estimate.error_mm.push_back(of_distance * to_next[last - 1].p95);
  estimate.error_mm.push_back(fall * estimate.error_mm.back());
  return estimate;
}

}  // namespace coapt
