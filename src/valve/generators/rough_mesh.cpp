#include "valve/generators/rough_mesh.hpp"

#include "valve/generators/rough_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace coapt {
namespace {

// Lengths of the open surface around and down [mm].
double length_around(const RoughSurface& surface, double t) {
  constexpr int kSteps = 400;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    sum += (surface.open(double(i + 1) / kSteps, t) - surface.open(double(i) / kSteps, t)).norm();
  return sum;
}

double length_down(const RoughSurface& surface) {
  double sum = 0;
  for (int i = 0; i < 50; ++i) sum += (surface.open(0.02 * i, 1) - surface.open(0.02 * i, 0)).norm();
  return sum / 50;
}

// A grid of about `triangles` with a column at each commissure, whose numbers go to `commissures`.
RoughTriangles coarse_grid(const RoughSurface& surface, int triangles, RandomSource& random,
                           std::vector<int>& commissures) {
  const double columns_per_row =
      0.5 * std::numbers::sqrt3 * length_around(surface, 0.3) / length_down(surface);
  const int rows = std::max(3, static_cast<int>(std::lround(std::sqrt(triangles / (2 * columns_per_row)))));
  const double columns = triangles / (2.0 * rows);
  std::vector<double> at;
  for (size_t k = 0; k < surface.begins.size(); ++k) {
    const double from = surface.begins[k], width = surface.end(k) - from;
    const int count = std::max(4, static_cast<int>(std::lround(columns * width)));
    commissures.push_back(static_cast<int>(at.size()));
    for (int i = 0; i < count; ++i)
      at.push_back(from + width * (i + (i > 0 ? random.between(-0.2, 0.2) : 0)) / count);
  }
  return staggered_strip(surface, at, rows);
}

void name_leaflets(const RoughSurface& surface, const RoughTriangles& mesh, TriangleMesh& leaflets) {
  leaflets.region_names = surface.leaflets;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    double sum = 0, rim_sum = 0;  // of u, the corners brought near the first one across u = 1
    int rim = 0;
    for (const int v : t) {
      const double u = mesh.at[v][0] - std::round(mesh.at[v][0] - mesh.at[t[0]][0]);
      sum += u;
      if (mesh.at[v][1] == 0) rim_sum += u, ++rim;
    }
    // The leaflets part at the commissure also where a triangle on the annulus leans across it.
    leaflets.regions.push_back(static_cast<int>(surface.leaflet_at(rim == 2 ? rim_sum / 2 : sum / 3)));
  }
}

// A triangle with none of its own leaflet across its edges, as a flip may leave one, goes to that of a
// neighbour.
void join_lone_triangles(TriangleMesh& leaflets) {
  std::map<std::pair<int, int>, size_t> first;  // triangle at each edge
  std::vector<bool> is_joined(leaflets.regions.size(), false);
  std::vector<int> beside = leaflets.regions;
  for (size_t t = 0; t < beside.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3i corners = leaflets.triangles.col(static_cast<Eigen::Index>(t));
      const auto [edge, is_new] = first.try_emplace(std::minmax({corners[k], corners[(k + 1) % 3]}), t);
      const size_t s = edge->second;
      if (is_new) continue;
      if (leaflets.regions[s] == leaflets.regions[t]) is_joined[s] = is_joined[t] = true;
      beside[s] = leaflets.regions[t], beside[t] = leaflets.regions[s];
    }
  for (size_t t = 0; t < beside.size(); ++t)
    if (!is_joined[t]) leaflets.regions[t] = beside[t];
}

}  // namespace

RoughMesh rough_mesh(const RoughSurface& surface, int triangles, RandomSource& random) {
  RoughMesh mesh;
  RoughTriangles rough = coarse_grid(surface, triangles / 3, random, mesh.commissures);
  const double around = 1 + random.below(4), phase = random.unit(), uneven = random.between(0.2, 0.7),
               down = random.between(-0.6, 0.9);
  const auto density = [=](const Eigen::Vector2d& at) {
    return std::exp(uneven * std::sin(2 * std::numbers::pi * (around * at[0] + phase)) +
                    down * (at[1] - 0.5));
  };
  const int slivers = std::max(3, triangles / 100);
  refine(surface, density, triangles - 2 * slivers, random, rough);
  for (int pass = 0; pass < 2; ++pass) jitter(surface, mesh.commissures, 0.6, random, rough);
  turn_edges(0.08, 20, random, rough);
  add_slivers(slivers, random, rough);

  const int count = static_cast<int>(rough.at.size());
  mesh.coordinates.resize(2, count);
  mesh.leaflets.vertices.resize(3, count);
  for (int v = 0; v < count; ++v) {
    mesh.coordinates.col(v) = rough.at[v];
    mesh.leaflets.vertices.col(v) = rough.x[v];
  }
  mesh.leaflets.triangles = rough.as_matrix();
  name_leaflets(surface, rough, mesh.leaflets);
  join_lone_triangles(mesh.leaflets);
  for (std::vector<int>& loop : boundary_loops(mesh.leaflets.triangles))
    (rough.at[loop.front()][1] == 0 ? mesh.annulus : mesh.free_edge) = std::move(loop);
  return mesh;
}

}  // namespace coapt
