#include "exchange/detail/start_contact.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "mesh/distance/separate.hpp"
#include "mesh/mesh_check.hpp"
#include "mesh/remesh/repair_slivers.hpp"
#include "scene/build/contact_pairs.hpp"
#include "valve/valve_check.hpp"

#include <algorithm>

namespace coapt::detail {
namespace {

constexpr double kGapPerEdge = 0.1;   // left between what was pushed apart, of the mean edge
constexpr double kMostPerEdge = 0.5;  // that a vertex may be moved by, of the mean edge

// Facets that repel each other begin apart or in one plane; a barrier only apart.
FacetPairs refused_pairs(const TriangleMesh& mesh, const std::string& contact) {
  if (contact != "facet") return intersecting_pairs(mesh.vertices, mesh.triangles);
  FacetPairs pairs;
  for (const MeshDefect& defect : check_mesh(mesh, {.orientation_matters = false, .contact = true}))
    if (defect.kind == MeshDefectKind::InitialIntersection)
      for (size_t k = 0; k + 1 < defect.elements.size(); k += 2)
        pairs.push_back({defect.elements[k], defect.elements[k + 1]});
  return pairs;
}

// True where all pairs are apart now; else the valve is as it was.
bool push_apart(const std::string& contact, Valve& valve, double& largest_move) {
  TriangleMesh& mesh = valve.leaflets;
  const double edge = mean_edge_length(mesh.vertices, mesh.triangles);
  SeparationOptions options;
  options.membrane_count = mesh.triangle_count();
  options.gap = kGapPerEdge * edge;
  options.is_held.assign(static_cast<size_t>(mesh.vertex_count()), false);
  for (const int v : valve.annulus) options.is_held[static_cast<size_t>(v)] = true;
  for (const Support& support : valve.supports)
    for (const int v : support.vertices) options.is_held[static_cast<size_t>(v)] = true;
  const Separation separation = separate(mesh.vertices, mesh.triangles, options);
  TriangleMesh moved = mesh;
  moved.vertices = separation.x;
  if (!separation.pairs_left.empty() || separation.largest_displacement > kMostPerEdge * edge ||
      !refused_pairs(moved, contact).empty() || !fold_doubts(moved).empty() ||
      slivers(moved, kSliverAspect).size() > slivers(mesh, kSliverAspect).size())
    return false;
  largest_move = separation.largest_displacement;
  mesh = std::move(moved);
  return true;
}

}  // namespace

void separate_leaflets(const ImportOptions& options, const std::string& place, Valve& valve,
                       std::vector<std::string>& warnings, Numbering numbering) {
  const FacetPairs pairs = refused_pairs(valve.leaflets, options.contact);
  if (pairs.empty()) return;
  const std::string found =
      place + std::to_string(pairs.size()) +
      (pairs.size() == 1 ? " pair of triangles touches or passes" : " pairs of triangles touch or pass") +
      " through each other (" + listed(pairs, numbering) + ")";
  if (options.contact == "none") {
    warnings.push_back(found +
                       "; the scene has no contact, so it can be solved, but neither the start nor "
                       "what comes of it need be a shape that leaflets can have.");
    return;
  }
  double largest_move = 0;
  if (options.repairs && push_apart(options.contact, valve, largest_move)) {
    warnings.push_back(found + " and were pushed apart; no vertex moved by more than " +
                       number_text(largest_move) + " mm. --no-repair keeps the mesh as it is.");
    return;
  }
  if (options.repairs && options.model.empty())
    throw InputError(found +
                     ", which no short push takes apart; contact needs a start without. Unfold or remesh the "
                     "leaflets there, leave contact out by --contact none, or keep them by --no-repair");
  warnings.push_back(found +
                     "; contact needs a start without: unfold or remesh the leaflets there, or try "
                     "`coapt check --repair push` on the scene.");
}

}  // namespace coapt::detail
