#include "valve/fibre_guides.hpp"

#include "core/error.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <set>

namespace coapt {
namespace {

using VertexPair = std::pair<int, int>;

VertexPair ordered(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// Lengths along the loop from its first vertex to each, and back to the first.
std::vector<double> lengths_along(const TriangleMesh& mesh, const std::vector<int>& loop) {
  std::vector<double> lengths{0};
  for (size_t k = 0; k < loop.size(); ++k)
    lengths.push_back(lengths.back() +
                      (mesh.vertices.col(loop[(k + 1) % loop.size()]) - mesh.vertices.col(loop[k])).norm());
  return lengths;
}

// Places of the trigones in the loop.
std::vector<size_t> places_in(const std::vector<int>& annulus, const std::vector<int>& trigones) {
  std::vector<size_t> places;
  std::vector<std::string> defects;
  for (const int v : trigones) {
    const auto found = std::find(annulus.begin(), annulus.end(), v);
    if (found == annulus.end())
      defects.push_back("trigone at vertex " + std::to_string(v) + ": is not on the annulus");
    else
      places.push_back(static_cast<size_t>(found - annulus.begin()));
  }
  if (!defects.empty()) throw InputError(defects);
  return places;
}

// Those of the annulus; `is_ring` gets every edge of it, guided or not.
std::vector<FibreGuide> annulus_guides(const TriangleMesh& mesh, const std::set<VertexPair>& edges,
                                       const std::vector<int>& annulus, const std::vector<int>& trigones,
                                       std::set<VertexPair>& ring) {
  const std::vector<double> at = lengths_along(mesh, annulus);
  const std::vector<size_t> places = places_in(annulus, trigones);
  std::vector<FibreGuide> guides;
  for (size_t k = 0; k < annulus.size(); ++k) {
    const size_t next = (k + 1) % annulus.size();
    const VertexPair edge = ordered(annulus[k], annulus[next]);
    if (!edges.contains(edge)) continue;
    ring.insert(edge);
    double distance = kInfinity;  // of the middle of the edge from the nearest trigone
    bool ends_at_trigone = false;
    for (const size_t place : places) {
      const double d = std::abs(0.5 * (at[k] + at[k + 1]) - at[place]);
      distance = std::min({distance, d, at.back() - d});
      ends_at_trigone = ends_at_trigone || place == k || place == next;
    }
    if (ends_at_trigone || distance < kRadialShare * at.back())
      guides.push_back({FibreGuide::Kind::Across, edge.first, edge.second, Vec3::Zero()});
    else if (distance >= kAlongShare * at.back())
      guides.push_back({FibreGuide::Kind::Along, edge.first, edge.second, Vec3::Zero()});
  }
  return guides;
}

// Directions of the chords at vertices where nothing else is known.
std::vector<FibreGuide> pull_guides(const TriangleMesh& mesh, const std::vector<FibreGuide>& others,
                                    const std::vector<FibrePull>& pulls) {
  constexpr double kLeastInSurface = 0.1;  // below, the direction of what is left is noise
  std::set<int> taken;
  for (const FibreGuide& guide : others) taken.insert({guide.a, guide.b});
  std::map<int, Vec3> sums, normals;
  for (const FibrePull& pull : pulls)
    if (!taken.contains(pull.vertex) && pull.direction.norm() > 0) {
      sums.try_emplace(pull.vertex, Vec3::Zero()).first->second += pull.weight * pull.direction.normalized();
      normals[pull.vertex] = Vec3::Zero();
    }
  for (const auto& t : mesh.triangles.colwise())
    for (const int v : t)
      if (const auto normal = normals.find(v); normal != normals.end())
        normal->second += area_vector(mesh.vertices, t);
  std::vector<FibreGuide> guides;
  for (const auto& [vertex, sum] : sums) {
    const Vec3 normal = normals[vertex].normalized(), part = sum - sum.dot(normal) * normal;
    if (normal.norm() > 0 && part.norm() > kLeastInSurface * sum.norm())
      guides.push_back({FibreGuide::Kind::AtVertex, vertex, vertex, part});
  }
  return guides;
}

}  // namespace

std::vector<FibreGuide> boundary_guides(const TriangleMesh& mesh) {
  std::vector<FibreGuide> guides;
  for (const Edge& edge : edges(mesh.triangles))
    if (edge.triangles.size() == 1) guides.push_back({FibreGuide::Kind::Along, edge.a, edge.b, Vec3::Zero()});
  return guides;
}

std::vector<FibreGuide> valve_guides(const TriangleMesh& mesh, const std::vector<int>& annulus,
                                     const std::vector<int>& trigones, const std::vector<FibrePull>& pulls) {
  std::set<VertexPair> all, ring;
  for (const Edge& edge : edges(mesh.triangles)) all.insert({edge.a, edge.b});
  std::vector<FibreGuide> guides = annulus_guides(mesh, all, annulus, trigones, ring);
  for (const FibreGuide& guide : boundary_guides(mesh))
    if (!ring.contains({guide.a, guide.b})) guides.push_back(guide);
  const std::vector<FibreGuide> at_chords = pull_guides(mesh, guides, pulls);
  guides.insert(guides.end(), at_chords.begin(), at_chords.end());
  return guides;
}

std::vector<int> region_meetings(const TriangleMesh& mesh, const std::vector<int>& annulus) {
  std::map<int, std::set<int>> regions;  // of the annulus' vertices
  for (const int v : annulus) regions[v];
  if (mesh.regions.empty()) return {};
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (const int v : mesh.triangles.col(t))
      if (const auto found = regions.find(v); found != regions.end())
        found->second.insert(mesh.regions[static_cast<size_t>(t)]);
  std::vector<int> meetings;
  for (const int v : annulus)
    if (regions[v].size() > 1) meetings.push_back(v);
  return meetings;
}

}  // namespace coapt
