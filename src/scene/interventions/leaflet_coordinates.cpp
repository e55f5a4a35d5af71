#include "scene/interventions/leaflet_coordinates.hpp"

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

// The longest stretch of the closed loop whose vertices are all members, in the order of the loop.
std::vector<int> longest_run(const std::vector<int>& loop, const std::vector<bool>& is_member) {
  const size_t n = loop.size();
  const auto belongs = [&](size_t k) { return is_member[static_cast<size_t>(loop[k % n])]; };
  size_t first = 0, best = 0, best_start = 0;
  while (first < n && belongs(first)) ++first;
  if (first == n) return loop;
  for (size_t k = first; k < first + n; ++k) {
    size_t count = 0;
    while (count < n && belongs(k + count)) ++count;
    if (count > best) {
      best = count;
      best_start = k;
    }
    k += count;
  }
  std::vector<int> run;
  for (size_t k = 0; k < best; ++k) run.push_back(loop[(best_start + k) % n]);
  return run;
}

FreeEdge measured(std::string leaflet, std::vector<int> vertices, const Points& x) {
  FreeEdge edge{std::move(leaflet), std::move(vertices), {0}, {}, {}};
  for (size_t k = 1; k < edge.vertices.size(); ++k)
    edge.along.push_back(edge.along.back() + (x.col(edge.vertices[k]) - x.col(edge.vertices[k - 1])).norm());
  return edge;
}

// Of two leaflets that share one commissure, both edges begin there.
void begin_where_they_meet(std::vector<FreeEdge>& edges, const Points& x) {
  const auto apart = [&](int v, const FreeEdge& other) {
    return std::min((x.col(v) - x.col(other.vertices.front())).norm(),
                    (x.col(v) - x.col(other.vertices.back())).norm());
  };
  const auto turned = [&](FreeEdge edge, const FreeEdge& other) {
    if (apart(edge.vertices.back(), other) < 0.5 * apart(edge.vertices.front(), other))
      std::reverse(edge.vertices.begin(), edge.vertices.end());
    return measured(edge.leaflet, edge.vertices, x);
  };
  edges = {turned(edges[0], edges[1]), turned(edges[1], edges[0])};
}

LeafletPoint nearest_on_edge(const FreeEdge& edge, const Points& vertices, const Vec3& position) {
  LeafletPoint place{0, 0, kInfinity};
  for (size_t k = 0; k + 1 < edge.vertices.size(); ++k) {
    const Vec3 a = vertices.col(edge.vertices[k]), side = vertices.col(edge.vertices[k + 1]) - a;
    const double length = edge.along[k + 1] - edge.along[k];
    const double part = length > 0 ? std::clamp(side.dot(position - a) / (length * length), 0.0, 1.0) : 0;
    const double depth = (position - a - part * side).norm();
    if (depth < place.depth) place = {0, edge.along[k] + part * length, depth};
  }
  return place;
}

// A polyline at equal parts of its length.
Points sampled(const Points& x, int count) {
  Points samples(3, count);
  std::vector<double> along{0};
  for (Eigen::Index k = 1; k < x.cols(); ++k)
    along.push_back(along.back() + (x.col(k) - x.col(k - 1)).norm());
  size_t k = 1;
  for (int s = 0; s < count; ++s) {
    const double at = along.back() * s / (count - 1);
    while (k + 1 < along.size() && along[k] < at) ++k;
    const double step = along[k] - along[k - 1], part = step > 0 ? (at - along[k - 1]) / step : 0;
    const auto b = static_cast<Eigen::Index>(k);
    samples.col(s) = (1 - part) * x.col(b - 1) + part * x.col(b);
  }
  return samples;
}

// Free edge and annulus of the leaflet side by side, beginning at the same end.
void lay_side_by_side(FreeEdge& edge, std::vector<int> annulus, const Points& x) {
  constexpr int kSamples = 201;
  if (annulus.size() < 2) return;
  const auto apart = [&](int a, int b) { return (x.col(a) - x.col(b)).norm(); };
  const int begin = edge.vertices.front(), end = edge.vertices.back();
  if (apart(annulus.front(), end) + apart(annulus.back(), begin) <
      apart(annulus.front(), begin) + apart(annulus.back(), end))
    std::reverse(annulus.begin(), annulus.end());
  edge.rim = sampled(x(Eigen::all, edge.vertices), kSamples);
  edge.root = sampled(x(Eigen::all, annulus), kSamples);
}

}  // namespace

std::vector<int> triangles_of(const std::string& region, const TriangleMesh& mesh) {
  std::vector<int> triangles;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    if (mesh.region_names[static_cast<size_t>(mesh.regions[static_cast<size_t>(t)])] == region)
      triangles.push_back(t);
  return triangles;
}

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
    for (const int t : triangles_of(leaflet, mesh))
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
    all.push_back(measured(leaflet, std::move(run), x));
  }
  if (all.size() == 2 && mesh.region_names.size() > 2) begin_where_they_meet(all, x);
  for (size_t k = 0; k < all.size(); ++k) lay_side_by_side(all[k], roots[k], x);
  return all;
}

LeafletPoint place_on(const FreeEdge& edge, const Points& vertices, const Vec3& position) {
  const Eigen::Index n = edge.root.cols();
  if (n < 2) return nearest_on_edge(edge, vertices, position);
  // At a part of the lengths between samples: the distance from the line there.
  const auto distance = [&](double at) {
    const auto k = std::min(static_cast<Eigen::Index>(at), n - 2);
    const double part = at - static_cast<double>(k);
    const Vec3 from = (1 - part) * edge.rim.col(k) + part * edge.rim.col(k + 1);
    const Vec3 line = (1 - part) * edge.root.col(k) + part * edge.root.col(k + 1) - from;
    const double t =
        line.squaredNorm() > 0 ? std::clamp(line.dot(position - from) / line.squaredNorm(), 0.0, 1.0) : 0;
    return std::pair((position - from - t * line).norm(), (position - from).norm());
  };
  Eigen::Index nearest = 0;
  for (Eigen::Index k = 1; k < n; ++k)
    if (distance(static_cast<double>(k)) < distance(static_cast<double>(nearest))) nearest = k;
  double low = static_cast<double>(std::max<Eigen::Index>(nearest - 1, 0)),
         high = static_cast<double>(std::min(nearest + 1, n - 1));
  constexpr int kThirds = 40;  // the interval ends at 1e-7 of a sample
  for (int k = 0; k < kThirds; ++k) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (distance(a).first <= distance(b).first ? high : low) = distance(a).first <= distance(b).first ? b : a;
  }
  const double at = 0.5 * (low + high);
  return {0, at / static_cast<double>(n - 1) * edge.length(), distance(at).second};
}

std::vector<LeafletPoint> leaflet_points(const FreeEdge& edge, const TriangleMesh& mesh) {
  std::set<int> vertices;
  for (const int t : triangles_of(edge.leaflet, mesh))
    for (const int v : mesh.triangles.col(t)) vertices.insert(v);
  std::vector<LeafletPoint> points;
  for (const int v : vertices) {
    points.push_back(place_on(edge, mesh.vertices, mesh.vertices.col(v)));
    points.back().vertex = v;
  }
  return points;
}

}  // namespace coapt
