#include "support/refined_valve.hpp"

#include "support/meshes.hpp"
#include "valve/generators/mitral.hpp"
#include "valve/generators/mitral_mesh.hpp"

#include <cmath>
#include <utility>
#include <vector>

namespace coapt {
namespace {

// Coordinates halfway; u runs around and starts anew at 1.
Eigen::Vector2d halfway(const Eigen::Vector2d& a, Eigen::Vector2d b) {
  b[0] += std::round(a[0] - b[0]);
  Eigen::Vector2d middle = 0.5 * (a + b);
  middle[0] -= std::floor(middle[0]);
  return middle;
}

}  // namespace

Valve refined_mitral_valve(int triangles, int refinements) {
  Valve valve = mitral_valve({.triangles = triangles, .preset = MitralPreset::Benchmark});
  const MitralShape shape = mitral_shape(mitral_dimensions(0, MitralPreset::Benchmark));
  const MitralMesh mesh = mitral_mesh(shape, triangles);
  std::vector<Eigen::Vector2d> coordinates(mesh.coordinates.colwise().begin(),
                                           mesh.coordinates.colwise().end());
  for (int level = 0; level < refinements; ++level)
    valve.leaflets.triangles = refined_uniformly(valve.leaflets.triangles, [&](int a, int b) {
      coordinates.push_back(halfway(coordinates[a], coordinates[b]));
      return static_cast<int>(coordinates.size()) - 1;
    });
  valve.leaflets.regions.clear();

  Points& x = valve.leaflets.vertices;
  x.resize(3, static_cast<Eigen::Index>(coordinates.size()));
  for (size_t k = 0; k < coordinates.size(); ++k)
    x.col(static_cast<Eigen::Index>(k)) = mitral_open_point(shape, coordinates[k][0], coordinates[k][1]);
  for (std::vector<int>& loop : boundary_loops(valve.leaflets.triangles))
    (coordinates[loop.front()][1] == 0 ? valve.annulus : valve.free_edge) = std::move(loop);
  valve.annulus_closed.resize(3, static_cast<Eigen::Index>(valve.annulus.size()));
  for (size_t k = 0; k < valve.annulus.size(); ++k)
    valve.annulus_closed.col(static_cast<Eigen::Index>(k)) =
        mitral_closed_point(shape, coordinates[valve.annulus[k]][0], 0);
  return valve;
}

}  // namespace coapt
