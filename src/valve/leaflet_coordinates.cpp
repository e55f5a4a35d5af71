#include "valve/leaflet_coordinates.hpp"

#include <algorithm>
#include <set>

namespace coapt {
namespace {

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

}  // namespace

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

FreeEdge free_edge_of(std::string leaflet, std::vector<int> vertices, const Points& x) {
  FreeEdge edge{std::move(leaflet), std::move(vertices), {0}, {}, {}};
  for (size_t k = 1; k < edge.vertices.size(); ++k)
    edge.along.push_back(edge.along.back() + (x.col(edge.vertices[k]) - x.col(edge.vertices[k - 1])).norm());
  return edge;
}

void begin_where_they_meet(std::vector<FreeEdge>& edges, const Points& x) {
  const auto apart = [&](int v, const FreeEdge& other) {
    return std::min((x.col(v) - x.col(other.vertices.front())).norm(),
                    (x.col(v) - x.col(other.vertices.back())).norm());
  };
  const auto turned = [&](FreeEdge edge, const FreeEdge& other) {
    if (apart(edge.vertices.back(), other) < 0.5 * apart(edge.vertices.front(), other))
      std::reverse(edge.vertices.begin(), edge.vertices.end());
    return free_edge_of(edge.leaflet, edge.vertices, x);
  };
  edges = {turned(edges[0], edges[1]), turned(edges[1], edges[0])};
}

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

std::vector<int> leaflet_triangles(const std::string& region, const TriangleMesh& mesh) {
  std::vector<int> triangles;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    if (mesh.region_names[static_cast<size_t>(mesh.regions[static_cast<size_t>(t)])] == region)
      triangles.push_back(t);
  return triangles;
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
  for (const int t : leaflet_triangles(edge.leaflet, mesh))
    for (const int v : mesh.triangles.col(t)) vertices.insert(v);
  std::vector<LeafletPoint> points;
  for (const int v : vertices) {
    points.push_back(place_on(edge, mesh.vertices, mesh.vertices.col(v)));
    points.back().vertex = v;
  }
  return points;
}

}  // namespace coapt
