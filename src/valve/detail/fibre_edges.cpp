#include "valve/detail/fibre_edges.hpp"

#include <map>

namespace coapt::fibres {
namespace {

int opposite_corner(const Eigen::Vector3i& t, const Edge& edge) {
  for (int k = 0; k < 3; ++k)
    if (t[k] != edge.a && t[k] != edge.b) return k;
  return 0;
}

}  // namespace

EdgeSpace edge_space(const TriangleMesh& mesh, bool joins_regions) {
  EdgeSpace space;
  for (const auto& t : mesh.triangles.colwise()) space.frames.emplace_back(mesh.vertices, t);
  space.sides.resize(space.frames.size());
  const bool is_cut = !joins_regions && !mesh.regions.empty();
  for (const Edge& edge : edges(mesh.triangles)) {
    std::map<int, int> unknown_of;  // by region
    for (const int t : edge.triangles) {
      const Eigen::Vector3i corners = mesh.triangles.col(t);
      const int k = opposite_corner(corners, edge);
      const Vec3 along = mesh.vertices.col(corners[(k + 2) % 3]) - mesh.vertices.col(corners[(k + 1) % 3]);
      const bool is_forward = corners[(k + 1) % 3] == edge.a;
      const auto found =
          unknown_of.try_emplace(is_cut ? mesh.regions[static_cast<size_t>(t)] : 0, space.count());
      if (found.second) {
        space.edges.push_back({edge.a, edge.b});
        space.triangles.emplace_back();
      }
      const int unknown = found.first->second;
      std::vector<int>& around = space.triangles[static_cast<size_t>(unknown)];
      bool is_mirrored = false;
      if (!around.empty()) {
        const Eigen::Vector3i first = mesh.triangles.col(around.front());
        is_mirrored = (first[(opposite_corner(first, edge) + 1) % 3] == edge.a) == is_forward;
      }
      around.push_back(t);
      space.sides[static_cast<size_t>(t)][static_cast<size_t>(k)] = {
          unknown, is_mirrored, unit(space.frames[static_cast<size_t>(t)].doubled(along))};
    }
  }
  return space;
}

}  // namespace coapt::fibres
