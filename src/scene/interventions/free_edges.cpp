#include "scene/interventions/free_edges.hpp"

#include "core/error.hpp"
#include "formats/json/suggestion.hpp"

#include <algorithm>
#include <set>

namespace coapt {
namespace {

std::vector<int> free_loop(const InterventionSpec& spec, const ValveEdit& edit) {
  const std::string where = spec.parameters.where();
  if (std::vector<int> named = edit.set("free_edge"); named.size() >= 3) return named;
  const std::vector<int> annulus = edit.set("annulus");
  const std::set<int> rim(annulus.begin(), annulus.end());
  std::vector<std::vector<int>> free;
  for (std::vector<int>& loop : boundary_loops(edit.mesh.triangles))
    if (std::none_of(loop.begin(), loop.end(), [&](int v) { return rim.contains(v); }))
      free.push_back(std::move(loop));
  if (rim.empty() || free.size() != 1)
    throw InputError(where +
                     ": which rim is the free edge cannot be told; name it as set \"free_edge\", in order");
  return free.front();
}

std::vector<std::string> wanted_leaflets(const InterventionSpec& spec, const TriangleMesh& mesh) {
  const Parameters& p = spec.parameters;
  for (const char* key : {"leaflets", "leaflet"}) {
    if (!p.has(key)) continue;
    std::vector<std::string> names =
        key == std::string("leaflet") ? std::vector<std::string>{p.text(key)} : p.texts(key);
    for (const std::string& name : names)
      if (std::find(mesh.region_names.begin(), mesh.region_names.end(), name) == mesh.region_names.end())
        throw InputError(p.where(key) + ": the mesh has no region \"" + name + "\"; its regions: " +
                         listed(mesh.region_names) + suggestion(name, mesh.region_names));
    return names;
  }
  return mesh.region_names;
}

}  // namespace

std::vector<FreeEdge> free_edges(const InterventionSpec& spec, const ValveEdit& edit) {
  const TriangleMesh& mesh = edit.mesh;
  const std::string where = spec.parameters.where();
  if (mesh.regions.empty())
    throw InputError(where +
                     ": the mesh has no regions; a place on a leaflet needs one region for each leaflet");
  const std::vector<int> loop = free_loop(spec, edit), commissures = edit.set("commissures"),
                         annulus = edit.set("annulus");
  std::vector<std::vector<int>> roots;
  const Points& x = mesh.vertices;
  std::vector<FreeEdge> all;
  for (const std::string& leaflet : wanted_leaflets(spec, mesh)) {
    std::vector<bool> is_member(static_cast<size_t>(mesh.vertex_count()), false);
    for (const int t : leaflet_triangles(leaflet, mesh))
      for (const int v : mesh.triangles.col(t)) is_member[static_cast<size_t>(v)] = true;
    std::vector<int> run = longest_run(loop, is_member);
    roots.push_back(annulus.empty() ? annulus : longest_run(annulus, is_member));
    if (run.size() < 3)
      throw InputError(where + ": region \"" + leaflet +
                       "\" does not reach the free edge; name the leaflets that are meant");
    const Vec3 begin = !commissures.empty() ? x.col(commissures.front())
                       : all.empty()        ? x.col(run.front())
                                            : x.col(all.front().vertices.front());
    if ((x.col(run.back()) - begin).norm() < (x.col(run.front()) - begin).norm())
      std::reverse(run.begin(), run.end());
    all.push_back(free_edge_of(leaflet, std::move(run), x));
  }
  if (all.size() == 2 && mesh.region_names.size() > 2) begin_where_they_meet(all, x);
  for (size_t k = 0; k < all.size(); ++k) lay_side_by_side(all[k], roots[k], x);
  return all;
}

}  // namespace coapt
