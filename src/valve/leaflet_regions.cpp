#include "valve/leaflet_regions.hpp"

#include "core/bounded_int.hpp"
#include "core/error.hpp"
#include "mesh/vertex_graph.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <queue>

namespace coapt {
namespace {

// Length of the shortest path along edges from the nearest of some vertices, infinite where there is none
// [length].
std::vector<double> path_lengths_from(const std::vector<int>& sources, const TriangleMesh& mesh) {
  const VertexGraph graph = vertex_graph(mesh.triangles, mesh.vertex_count());
  const auto count = static_cast<size_t>(mesh.vertex_count());
  std::vector<double> ways(count, kInfinity);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (const int source : sources) {
    ways[static_cast<size_t>(source)] = 0;
    queue.emplace(0, source);
  }
  while (!queue.empty()) {
    const auto [length, vertex] = queue.top();
    queue.pop();
    if (length > ways[static_cast<size_t>(vertex)]) continue;
    for (const int next : graph.of(vertex)) {
      const double there = length + (mesh.vertices.col(vertex) - mesh.vertices.col(next)).norm();
      const auto n = static_cast<size_t>(next);
      if (there >= ways[n]) continue;
      ways[n] = there;
      queue.emplace(there, next);
    }
  }
  return ways;
}

// Angle of a point around the annulus: about the mean of its points, in the plane of its area vector.
class Around {
 public:
  Around(const std::vector<int>& annulus, const Points& x)
      : centre_(x(Eigen::all, annulus).rowwise().mean()) {
    Vec3 area = Vec3::Zero();
    for (size_t k = 0; k < annulus.size(); ++k)
      area +=
          Vec3(x.col(annulus[k]) - centre_).cross(Vec3(x.col(annulus[(k + 1) % annulus.size()]) - centre_));
    const Vec3 first = x.col(annulus.front()) - centre_;
    across_ = area.cross(first).normalized();
    along_ = across_.cross(area).normalized();
  }
  double angle(const Vec3& point) const {
    return std::atan2(across_.dot(point - centre_), along_.dot(point - centre_));
  }

 private:
  Vec3 centre_, along_, across_;
};

std::vector<int> free_edge_of(const TriangleMesh& mesh, const std::vector<int>& annulus) {
  std::vector<int> free_edge;
  for (const auto& loop : boundary_loops(mesh.triangles))
    for (const int v : loop)
      if (std::find(annulus.begin(), annulus.end(), v) == annulus.end()) free_edge.push_back(v);
  return free_edge;
}

// Places on a circle turned so that the widest gap between them lies at the end.
void turn(std::vector<double>& places, double circle) {
  std::vector<double> sorted = places;
  std::sort(sorted.begin(), sorted.end());
  double start = sorted.front(), widest = sorted.front() + circle - sorted.back();
  for (size_t k = 1; k < sorted.size(); ++k)
    if (sorted[k] - sorted[k - 1] > widest) {
      widest = sorted[k] - sorted[k - 1];
      start = sorted[k];
    }
  for (double& place : places) place = place < start ? place + circle - start : place - start;
}

// Sectors of each leaflet: shares of the areas, at least one, the largest remainders first.
std::vector<int> shared_out(int sectors, const std::vector<double>& areas) {
  const double sum = std::accumulate(areas.begin(), areas.end(), 0.0);
  std::vector<int> result(areas.size(), 1);
  for (int left = sectors - static_cast<int>(areas.size()); left > 0; --left) {
    const auto lack = [&](size_t k) { return areas[k] / sum * sectors - result[k]; };
    size_t poorest = 0;
    for (size_t k = 1; k < areas.size(); ++k)
      if (lack(k) > lack(poorest)) poorest = k;
    ++result[poorest];
  }
  return result;
}

std::string zone_name(int zone, int zones) {
  if (zone == 0) return "annulus";
  return zone == zones - 1 ? "edge" : "belly" + (zones > 3 ? std::to_string(zone) : "");
}

Vec3 centroid(const TriangleMesh& mesh, int triangle) {
  return mesh.vertices(Eigen::all, mesh.triangles.col(triangle)).rowwise().mean();
}

// 0 at the annulus, 1 at the free edge, or, without one, where it is farthest; 1 for what does not hang on
// it.
double depth_of(const Eigen::Vector3i& triangle, const std::vector<double>& from_annulus,
                const std::vector<double>& from_edge, double farthest) {
  double down = 0, up = 0;
  for (const int v : triangle) {
    down += from_annulus[static_cast<size_t>(v)];
    up += from_edge[static_cast<size_t>(v)];
  }
  if (!std::isfinite(down)) return 1;
  return std::isfinite(up) ? down / (down + up) : down / (3 * farthest);
}

// Cuts a zone into sectors of equal area, by place; adds them to the regions.
void cut_zone(const TriangleMesh& mesh, std::vector<std::pair<double, int>> triangles, int sectors,
              const std::string& name, LeafletRegions& regions) {
  std::sort(triangles.begin(), triangles.end());
  const auto area = [&](int t) { return area_vector(mesh.vertices, mesh.triangles.col(t)).norm(); };
  double whole = 0, before = 0;
  for (const auto& [place, t] : triangles) whole += area(t);
  int last = -1;
  for (const auto& [place, t] : triangles) {
    const int sector = bounded_int((before + 0.5 * area(t)) / whole * sectors, 0, sectors - 1);
    before += area(t);
    if (sector != last) regions.names.push_back(name + std::to_string(sector + 1));
    last = sector;
    regions.of_triangle[static_cast<size_t>(t)] = static_cast<int>(regions.names.size()) - 1;
  }
}

}  // namespace

LeafletRegions leaflet_regions(const TriangleMesh& mesh, const std::vector<int>& annulus, int wanted,
                               int zones) {
  std::vector<std::vector<int>> leaflets(std::max<size_t>(1, mesh.region_names.size()));
  for (int t = 0; t < mesh.triangle_count(); ++t)
    leaflets[mesh.regions.empty() ? 0 : static_cast<size_t>(mesh.regions[static_cast<size_t>(t)])].push_back(
        t);
  std::vector<std::string> names = mesh.region_names;
  if (names.empty()) names.emplace_back("leaflet");
  for (size_t k = leaflets.size(); k-- > 0;)
    if (leaflets[k].empty()) {
      leaflets.erase(leaflets.begin() + static_cast<long>(k));
      names.erase(names.begin() + static_cast<long>(k));
    }
  if (zones < 1) throw InputError("a leaflet has one zone at least, not " + std::to_string(zones));
  if (wanted % zones != 0 || wanted / zones < static_cast<int>(leaflets.size()))
    throw InputError(std::to_string(wanted) + " regions cannot be made of " +
                     std::to_string(leaflets.size()) + " leaflets with " + std::to_string(zones) +
                     " zones each; take a multiple of " + std::to_string(zones) + ", at least " +
                     std::to_string(zones * static_cast<int>(leaflets.size())));
  for (const int v : annulus)
    if (v < 0 || v >= mesh.vertex_count())
      throw InputError("the annulus names node " + std::to_string(v) + ", which is none of the " +
                       std::to_string(mesh.vertex_count()) +
                       " vertices of the leaflets; it must be a loop of their rim");
  std::vector<double> areas(leaflets.size(), 0);
  for (size_t k = 0; k < leaflets.size(); ++k)
    for (const int t : leaflets[k]) areas[k] += area_vector(mesh.vertices, mesh.triangles.col(t)).norm();
  const std::vector<int> sectors = shared_out(wanted / zones, areas);

  const std::vector<double> from_annulus = path_lengths_from(annulus, mesh),
                            from_edge = path_lengths_from(free_edge_of(mesh, annulus), mesh);
  double farthest = 0;
  for (const double length : from_annulus)
    if (std::isfinite(length)) farthest = std::max(farthest, length);
  if (farthest == 0)
    throw InputError(
        "the annulus holds every vertex of the leaflets that hang on it, so that nothing lies between it and "
        "a free edge; name the loop of their rim alone");
  const Around around(annulus, mesh.vertices);
  LeafletRegions result;
  result.of_triangle.resize(static_cast<size_t>(mesh.triangle_count()));
  for (size_t k = 0; k < leaflets.size(); ++k) {
    std::vector<double> places;
    std::vector<std::vector<std::pair<double, int>>> in_zone(static_cast<size_t>(zones));  // place, triangle
    for (const int t : leaflets[k]) places.push_back(around.angle(centroid(mesh, t)));
    turn(places, 2 * std::numbers::pi);
    for (size_t i = 0; i < leaflets[k].size(); ++i) {
      const double depth = depth_of(mesh.triangles.col(leaflets[k][i]), from_annulus, from_edge, farthest);
      in_zone[static_cast<size_t>(bounded_int(depth * zones, 0, zones - 1))].emplace_back(places[i],
                                                                                          leaflets[k][i]);
    }
    for (int zone = 0; zone < zones; ++zone)
      cut_zone(mesh, in_zone[static_cast<size_t>(zone)], sectors[k],
               names[k] + "/" + zone_name(zone, zones) + "/", result);
  }
  return result;
}

}  // namespace coapt
