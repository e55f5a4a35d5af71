// A patch: part of a leaflet replaced by another material.
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "scene/interventions/free_edges.hpp"
#include "scene/terms/term_types.hpp"

#include <cmath>
#include <utility>

namespace coapt {
namespace {

// The vertex of the leaflet nearest to a place on it, and how far its own place is from that [mm].
std::pair<int, double> nearest_vertex(const FreeEdge& edge, const TriangleMesh& mesh, double along,
                                      double depth) {
  std::pair<int, double> best{0, kInfinity};
  for (const LeafletPoint& point : leaflet_points(edge, mesh))
    if (const double distance = std::hypot(point.along - along, point.depth - depth); distance < best.second)
      best = {point.vertex, distance};
  return best;
}

void cover_by_patch(const InterventionSpec& spec, ValveEdit& valve) {
  const Parameters& p = spec.parameters;
  const TriangleMesh& mesh = valve.mesh;
  const FreeEdge edge = free_edges(spec, valve).front();
  const double radius = p.number("radius");
  const auto [middle, away] = nearest_vertex(edge, mesh, p.number("at") * edge.length(), p.number("depth"));
  constexpr double kNear = 2;  // mean edges; on the leaflet no place is that far from a vertex
  if (away > kNear * mean_edge_length(mesh.vertices, mesh.triangles))
    throw InputError(p.where("depth") + ": \"" + edge.leaflet +
                     "\" has no place so far from its free edge there; the nearest is " + number_text(away) +
                     " mm off, at a depth of " +
                     number_text(place_on(edge, mesh.vertices, mesh.vertices.col(middle)).depth) + " mm");
  Vector patch = Vector::Zero(mesh.triangle_count());
  for (const int t : leaflet_triangles(edge.leaflet, mesh)) {
    const Vec3 centroid = mesh.vertices(Eigen::all, mesh.triangles.col(t)).rowwise().mean();
    if ((centroid - mesh.vertices.col(middle)).norm() <= radius) patch[t] = 1;
  }
  if (patch.sum() == 0)
    throw InputError(p.where() + ": the patch covers no triangle of \"" + edge.leaflet +
                     "\"; make its radius greater than the edges of the mesh");
  for (auto& [name, other] : valve.patches) other = other.cwiseMin((1 - patch.array()).matrix());
  valve.patches[spec.name] = std::move(patch);
}

TermSpec patch_membrane(const InterventionSpec& spec, const Scene&) {
  TermSpec membrane = term_with_defaults("cst_tension_field", spec);
  for (const char* key : {"young", "poisson", "thickness"})
    membrane.parameters.set(key, spec.parameters.number(key));
  return membrane;
}

}  // namespace

InterventionType patch_intervention() {
  return {
      .name = "patch",
      .summary =
          "A round part of a leaflet is replaced by another material of the same shape, such as "
          "pericardium; the membrane is a tension field.",
      .spec = {.keys = {{.name = "leaflet", .kind = KeyKind::Text, .required = true, .doc = "Its region."},
                        {.name = "at",
                         .required = true,
                         .min = 0,
                         .max = 1,
                         .doc = "Middle of the patch, as the fraction of the free edge's length from the "
                                "first commissure."},
                        {.name = "depth",
                         .dimension = kLength,
                         .required = true,
                         .min = 0,
                         .doc = "Distance of the middle from the free edge."},
                        {.name = "radius",
                         .dimension = kLength,
                         .required = true,
                         .min = 0,
                         .excludes_min = true,
                         .doc = "Triangles whose centroid lies within this distance of the vertex nearest to "
                                "the middle."},
                        {.name = "young",
                         .dimension = kPressure,
                         .required = true,
                         .min = 0,
                         .excludes_min = true,
                         .doc = "Young's modulus."},
                        {.name = "poisson",
                         .fallback = "0.45",
                         .min = -1,
                         .max = 0.4999,
                         .excludes_min = true,
                         .doc = "Poisson's ratio."},
                        {.name = "thickness",
                         .dimension = kLength,
                         .required = true,
                         .min = 0,
                         .excludes_min = true,
                         .doc = "Thickness."}}},
      .edit = cover_by_patch,
      .term = patch_membrane};
}

}  // namespace coapt
