#include "results/reference/reference_distance.hpp"

#include "core/error.hpp"
#include "results/reference/registered_reference.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

namespace coapt {
namespace {

DistanceFigures figures(const SurfaceDistance& distance) {
  return {distance.mean, distance.p95, distance.max};
}

// The facets by their corners, however a file lists them: corners in ascending order, and so the facets.
std::vector<std::array<int, 3>> facets(const Triangles& triangles) {
  std::vector<std::array<int, 3>> all;
  all.reserve(static_cast<size_t>(triangles.cols()));
  for (const auto& t : triangles.colwise()) {
    std::array<int, 3> corners{t[0], t[1], t[2]};
    std::sort(corners.begin(), corners.end());
    all.push_back(corners);
  }
  std::sort(all.begin(), all.end());
  return all;
}

struct BothWays {
  SurfaceDistance there, back;  // from the solved surface to the reference, and from it
};

BothWays both_ways(const TriangleMesh& closed, const TriangleMesh& reference,
                   const UncountedVertices& uncounted) {
  return {surface_distance(closed, reference, uncounted),
          surface_distance(reference, closed, {uncounted.to, uncounted.from})};
}

ReferenceDistance summary(const BothWays& both, const TriangleMesh& closed, const TriangleMesh& reference,
                          const UncountedVertices& uncounted) {
  const std::vector<int> left_out = either_of(uncounted.from, uncounted.to, closed.vertices.cols());
  ReferenceDistance distance{figures(both.there), figures(both.back), {}, static_cast<int>(left_out.size())};
  const bool is_same_mesh = reference.vertices.cols() == closed.vertices.cols() &&
                            facets(reference.triangles) == facets(closed.triangles);
  if (is_same_mesh) distance.same_vertex = apart(reference.vertices, closed.vertices, left_out);
  return distance;
}

// In the view of the solved shape, in which the reference lies in its place.
std::optional<LineDistance> distance_of_lines(const Model& model, const std::optional<Closure>& closure,
                                              const Fields& fields, const TriangleMesh& reference) {
  if (!closure || closure->line.empty()) return std::nullopt;
  const std::vector<int>& loop = *annulus_of(model);
  return line_distance(closure->line,
                       coaptation_line_of(reference, fields.x(Eigen::all, loop),
                                          annulus_frame(model, fields, loop), fields.contact_distance));
}

}  // namespace

DistanceFigures both_directions(const DistanceFigures& to, const DistanceFigures& from) {
  return {(to.mean + from.mean) / 2, std::max(to.p95, from.p95), std::max(to.max, from.max)};
}

DistanceFigures both_directions(const ReferenceDistance& distance) {
  return both_directions(distance.to_reference, distance.from_reference);
}

DistanceFigures distance_between(const TriangleMesh& a, const TriangleMesh& b) {
  return both_directions(figures(surface_distance(a, b)), figures(surface_distance(b, a)));
}

TriangleMesh surface_at(const Model& model, const Points& x) {
  TriangleMesh surface = model.mesh;
  surface.vertices = x.leftCols(model.mesh.vertex_count());
  return surface;
}

ReferenceDistance reference_distance(const TriangleMesh& closed, const TriangleMesh& reference,
                                     Vector& vertex_distances, const UncountedVertices& uncounted) {
  const BothWays both = both_ways(closed, reference, uncounted);
  vertex_distances = both.there.vertex_distances;
  return summary(both, closed, reference, uncounted);
}

std::optional<ReferenceDistance> compare_with_reference(const Model& model, Fields& fields,
                                                        const std::vector<int>& free_nodes,
                                                        const std::optional<Closure>& closure) {
  if (!model.closed_reference) return std::nullopt;
  const TriangleMesh closed = surface_at(model, fields.x);
  const UncountedVertices uncounted{free_nodes, {}};
  ReferenceDistance as_given =
      reference_distance(closed, *model.closed_reference, fields.reference_distance, uncounted);
  if (!model.registration) {
    as_given.lines = distance_of_lines(model, closure, fields, *model.closed_reference);
    return as_given;
  }
  RegisteredReference registered;
  try {
    registered = registered_reference(model, closed);
  } catch (const InputError& error) {
    ReferenceDistance doubtful = as_given;
    doubtful.doubts = {std::string(error.what()) + "; the distances are those of the reference as it lies."};
    return doubtful;
  }
  const BothWays both = both_ways(closed, registered.surface, uncounted);
  ReferenceDistance distance = summary(both, closed, registered.surface, uncounted);
  AppliedRegistration applied{*registered.registration,
                              moved_by(registered.registration->motion, model.closed_reference->vertices),
                              as_given.to_reference, as_given.from_reference};
  RigidMotion& motion = applied.found.motion;
  motion.translation += model.origin - motion.scale * (motion.rotation * model.origin);
  for (const std::string& doubt : registration_doubts(applied.found))
    distance.doubts.push_back("reference.register: " + doubt + ".");
  distance.registration = std::move(applied);
  distance.lines = distance_of_lines(model, closure, fields, registered.surface);
  fields.reference_distance = both.there.vertex_distances;
  fields.registered_distance = both.back.vertex_distances;
  fields.registered_reference = std::move(registered.surface);
  return distance;
}

VertexDistance apart(const Points& a, const Points& b, const std::vector<int>& left_out) {
  if (a.cols() == 0) return {};
  VertexDistance distance;
  int count = 0;
  for (int k = 0; k < static_cast<int>(a.cols()); ++k) {
    if (std::binary_search(left_out.begin(), left_out.end(), k)) continue;
    const double here = (a.col(k) - b.col(k)).norm();
    distance.mean += here;
    distance.max = std::max(distance.max, here);
    ++count;
  }
  if (count == 0) return {kNaN, kNaN};
  distance.mean /= count;
  return distance;
}

std::vector<int> either_of(const std::vector<int>& a, const std::vector<int>& b, Eigen::Index count) {
  std::vector<int> both;
  std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  std::erase_if(both, [count](int k) { return k >= count; });
  return both;
}

}  // namespace coapt
