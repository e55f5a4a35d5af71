#include "valve/separate_leaflets.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "mesh/distance/separate.hpp"

namespace coapt {
namespace {

constexpr double kSeparationPerEdge = 0.1;  // gap between what was pushed apart, in mean edges
constexpr double kFarthestPerEdge = 2;      // a vertex that has to move farther is no place of the leaflets

std::string place_of(const TriangleMesh& mesh, int triangle) {
  const Vec3 middle = mesh.vertices(Eigen::all, mesh.triangles.col(triangle)).rowwise().mean();
  return "(" + number_text(middle.x(), 3) + ", " + number_text(middle.y(), 3) + ", " +
         number_text(middle.z(), 3) + ")";
}

}  // namespace

LeafletSeparation separate_leaflets(Valve& valve) {
  TriangleMesh& mesh = valve.leaflets;
  SeparationOptions options;
  options.membrane_count = mesh.triangle_count();
  const auto pairs = pairs_to_separate(mesh.vertices, mesh.triangles, options.membrane_count, {});
  if (pairs.empty()) return {};
  const double edge = mean_edge_length(mesh.vertices, mesh.triangles);
  options.gap = kSeparationPerEdge * edge;
  options.is_held.assign(static_cast<size_t>(mesh.vertex_count()), false);
  for (const int vertex : valve.annulus) options.is_held[static_cast<size_t>(vertex)] = true;
  const Separation apart = separate(mesh.vertices, mesh.triangles, options);
  if (!apart.pairs_left.empty() || apart.largest_displacement > kFarthestPerEdge * edge)
    throw InputError("the leaflets pass through themselves: " + std::to_string(pairs.size()) +
                     " pairs of triangles have no short way out, the first at " +
                     place_of(mesh, pairs.front()[0]) +
                     "; cut that part away, or give a mask of the leaflets, which says where they end");
  mesh.vertices = apart.x;
  return {static_cast<int>(pairs.size()), apart.largest_displacement};
}

}  // namespace coapt
