#include "mesh/remesh/round_triangles.hpp"

#include "mesh/curve_match.hpp"
#include "mesh/distance/triangle_tree.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

namespace coapt {
namespace {

constexpr double kGoodAngle = 30;    // below it an angle never gets smaller [degrees]
constexpr double kFlipCosine = 0.8;  // between the normals at an edge that may be flipped
constexpr double kLeastGain = 1e-3;  // of a flip, so that no edge is flipped to and fro [degrees]
constexpr double kCutAngle = 20;     // a triangle with two edges on a rim is cut off below it [degrees]
constexpr int kCollapses = 20;       // rounds at most, in each of which edges apart from each other go
constexpr double kWay = 0.7;         // towards the middle of the neighbours, at each round

double angle_at(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a;
  return std::atan2(ab.cross(ac).norm(), ab.dot(ac)) * 180 / std::numbers::pi;
}

double least_angle_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  return std::min({angle_at(a, b, c), angle_at(b, c, a), angle_at(c, a, b)});
}

int opposite(const Eigen::Vector3i& t, const Edge& edge) {
  return t[0] != edge.a && t[0] != edge.b ? t[0] : t[1] != edge.a && t[1] != edge.b ? t[1] : t[2];
}

// The closed polygons of the rims of a surface.
std::vector<Points> rims_of(const TriangleMesh& surface) {
  std::vector<Points> rims;
  for (const std::vector<int>& loop : boundary_loops(surface.triangles)) {
    Points rim(3, static_cast<Eigen::Index>(loop.size()));
    for (size_t k = 0; k < loop.size(); ++k)
      rim.col(static_cast<Eigen::Index>(k)) = surface.vertices.col(loop[k]);
    rims.push_back(rim);
  }
  return rims;
}

// What is around each vertex, and on which rim it lies (-1: inside).
struct Surroundings {
  std::vector<std::vector<int>> triangles;
  std::vector<int> rim;
  std::vector<std::array<int, 2>> rim_neighbours;
};

Surroundings surroundings(const TriangleMesh& mesh, const std::vector<Points>& rims) {
  const auto n = static_cast<size_t>(mesh.vertex_count());
  Surroundings around{std::vector<std::vector<int>>(n), std::vector<int>(n, -1),
                      std::vector<std::array<int, 2>>(n, {-1, -1})};
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) around.triangles[static_cast<size_t>(mesh.triangles(k, t))].push_back(t);
  for (const std::vector<int>& loop : boundary_loops(mesh.triangles)) {
    const Vec3 first = mesh.vertices.col(loop.front());
    const auto nearest = std::min_element(rims.begin(), rims.end(), [&](const Points& a, const Points& b) {
      return (closest_on_curve(a, first) - first).squaredNorm() <
             (closest_on_curve(b, first) - first).squaredNorm();
    });
    for (size_t k = 0; k < loop.size(); ++k) {
      const auto v = static_cast<size_t>(loop[k]);
      around.rim[v] = static_cast<int>(nearest - rims.begin());
      around.rim_neighbours[v] = {loop[(k + loop.size() - 1) % loop.size()], loop[(k + 1) % loop.size()]};
    }
  }
  return around;
}

double least_around(const TriangleMesh& mesh, const std::vector<int>& triangles) {
  double least = 180;
  for (const int t : triangles)
    least = std::min(least, least_angle_of(mesh.vertices.col(mesh.triangles(0, t)),
                                           mesh.vertices.col(mesh.triangles(1, t)),
                                           mesh.vertices.col(mesh.triangles(2, t))));
  return least;
}

// Whether a triangle around a vertex is turned over when that moves there.
bool turns_over(const TriangleMesh& mesh, const std::vector<int>& triangles, int vertex, const Vec3& there) {
  return std::any_of(triangles.begin(), triangles.end(), [&](int t) {
    const Eigen::Vector3i corners = mesh.triangles.col(t);
    std::array<Vec3, 3> x;
    for (int k = 0; k < 3; ++k)
      x[static_cast<size_t>(k)] = corners[k] == vertex ? there : Vec3(mesh.vertices.col(corners[k]));
    return (x[1] - x[0]).cross(x[2] - x[0]).dot(area_vector(mesh.vertices, corners)) <= 0;
  });
}

void move_vertices(TriangleMesh& mesh, const TriangleTree& tree, const std::vector<Points>& rims) {
  const Surroundings around = surroundings(mesh, rims);
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const auto at = static_cast<size_t>(v);
    const std::vector<int>& triangles = around.triangles[at];
    if (triangles.empty()) continue;
    Vec3 middle = Vec3::Zero();
    const bool is_inside = around.rim[at] < 0;
    if (is_inside) {
      double weights = 0;
      for (const int t : triangles) {
        const double area = area_vector(mesh.vertices, mesh.triangles.col(t)).norm();
        for (int k = 0; k < 3; ++k) middle += area / 3 * mesh.vertices.col(mesh.triangles(k, t));
        weights += area;
      }
      middle /= weights;
    } else {
      for (const int neighbour : around.rim_neighbours[at]) middle += 0.5 * mesh.vertices.col(neighbour);
    }
    const Vec3 before = mesh.vertices.col(v), wanted = before + kWay * (middle - before);
    const Vec3 there = is_inside ? tree.closest(wanted).point
                                 : closest_on_curve(rims[static_cast<size_t>(around.rim[at])], wanted);
    if (turns_over(mesh, triangles, v, there)) continue;
    const double least = least_around(mesh, triangles);
    mesh.vertices.col(v) = there;
    if (least_around(mesh, triangles) < std::min(least, kGoodAngle)) mesh.vertices.col(v) = before;
  }
}

void flip_edges(TriangleMesh& mesh) {
  const std::vector<Edge> all = edges(mesh.triangles);
  std::set<std::pair<int, int>> joined;
  for (const Edge& edge : all) joined.insert({edge.a, edge.b});
  std::vector<bool> is_touched(static_cast<size_t>(mesh.triangle_count()), false);
  for (const Edge& edge : all) {
    if (edge.triangles.size() != 2) continue;
    const int left = edge.triangles[0], right = edge.triangles[1];
    if (is_touched[static_cast<size_t>(left)] || is_touched[static_cast<size_t>(right)]) continue;
    const Eigen::Vector3i t = mesh.triangles.col(left);
    const int c = opposite(t, edge), d = opposite(mesh.triangles.col(right), edge);
    if (!joined.insert({std::min(c, d), std::max(c, d)}).second) continue;
    const auto at_c = std::find(t.begin(), t.end(), c) - t.begin();
    const int a = t[(at_c + 1) % 3], b = t[(at_c + 2) % 3];  // the triangle runs c, a, b
    const auto x = [&](int v) -> Vec3 { return mesh.vertices.col(v); };
    const Vec3 n1 = (x(a) - x(c)).cross(x(b) - x(c)).normalized();
    const Vec3 n2 = (x(b) - x(d)).cross(x(a) - x(d)).normalized();
    const Vec3 n3 = (x(a) - x(c)).cross(x(d) - x(c)).normalized();
    const Vec3 n4 = (x(d) - x(c)).cross(x(b) - x(c)).normalized();
    const double before = std::min(least_angle_of(x(c), x(a), x(b)), least_angle_of(x(d), x(b), x(a)));
    const double after = std::min(least_angle_of(x(c), x(a), x(d)), least_angle_of(x(c), x(d), x(b)));
    const bool is_flat = n1.dot(n2) > kFlipCosine && n3.dot(n4) > kFlipCosine && n1.dot(n3) > kFlipCosine;
    if (!is_flat || after < before + kLeastGain) {
      joined.erase({std::min(c, d), std::max(c, d)});
      continue;
    }
    mesh.triangles.col(left) << c, a, d;
    mesh.triangles.col(right) << c, d, b;
    is_touched[static_cast<size_t>(left)] = is_touched[static_cast<size_t>(right)] = true;
    joined.erase({edge.a, edge.b});
  }
}

// The triangles at each vertex, and which vertices lie on a rim.
struct Corners {
  std::vector<std::vector<int>> triangles;
  std::vector<char> is_rim;
};

Corners corners_of(const TriangleMesh& mesh, const std::vector<Edge>& all) {
  const auto n = static_cast<size_t>(mesh.vertex_count());
  Corners corners{std::vector<std::vector<int>>(n), std::vector<char>(n, 0)};
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (const int v : mesh.triangles.col(t)) corners.triangles[static_cast<size_t>(v)].push_back(t);
  for (const Edge& edge : all)
    if (edge.triangles.size() == 1)
      corners.is_rim[static_cast<size_t>(edge.a)] = corners.is_rim[static_cast<size_t>(edge.b)] = 1;
  return corners;
}

std::set<int> neighbours_of(const TriangleMesh& mesh, const Corners& corners, int vertex) {
  std::set<int> around;
  for (const int t : corners.triangles[static_cast<size_t>(vertex)])
    for (const int v : mesh.triangles.col(t)) around.insert(v);
  around.erase(vertex);
  return around;
}

// Whether the mesh stays manifold, with the same rims, when the edge becomes a point.
bool can_collapse(const TriangleMesh& mesh, const Corners& corners, const Edge& edge) {
  const auto is_rim = [&](int v) { return corners.is_rim[static_cast<size_t>(v)] != 0; };
  if (edge.triangles.size() == 2 && is_rim(edge.a) && is_rim(edge.b)) return false;
  const std::set<int> a = neighbours_of(mesh, corners, edge.a), b = neighbours_of(mesh, corners, edge.b);
  return static_cast<size_t>(std::count_if(a.begin(), a.end(), [&](int v) { return b.contains(v); })) ==
         edge.triangles.size();
}

// Moves both ends to one place, b becoming a; false, and nothing is changed, where no angle grows by it.
bool collapse(TriangleMesh& mesh, const Corners& corners, const Edge& edge) {
  const auto a = static_cast<size_t>(edge.a), b = static_cast<size_t>(edge.b);
  std::vector<int> around = corners.triangles[a];
  around.insert(around.end(), corners.triangles[b].begin(), corners.triangles[b].end());
  const double least = least_around(mesh, around);
  std::erase_if(around,
                [&](int t) { return std::count(edge.triangles.begin(), edge.triangles.end(), t) > 0; });
  if (around.empty()) return false;
  const Vec3 at_a = mesh.vertices.col(edge.a), at_b = mesh.vertices.col(edge.b);
  const Vec3 there = corners.is_rim[a] == corners.is_rim[b] ? Vec3(0.5 * (at_a + at_b))
                     : corners.is_rim[a] != 0               ? at_a
                                                            : at_b;
  std::vector<Vec3> normals;
  for (const int t : around)
    normals.push_back(area_vector(mesh.vertices, mesh.triangles.col(t)).normalized());
  mesh.vertices.col(edge.a) = mesh.vertices.col(edge.b) = there;
  bool is_better = least_around(mesh, around) > least;
  for (size_t k = 0; k < around.size(); ++k)
    is_better = is_better && area_vector(mesh.vertices, mesh.triangles.col(around[k])).dot(normals[k]) > 0;
  if (!is_better) {
    mesh.vertices.col(edge.a) = at_a;
    mesh.vertices.col(edge.b) = at_b;
    return false;
  }
  for (const int t : corners.triangles[b])
    for (int& v : mesh.triangles.col(t))
      if (v == edge.b) v = edge.a;
  return true;
}

double longest_edge(const TriangleMesh& mesh, int t) {
  const Eigen::Matrix3d x = mesh.vertices(Eigen::all, mesh.triangles.col(t));
  return std::max({(x.col(0) - x.col(1)).norm(), (x.col(1) - x.col(2)).norm(), (x.col(2) - x.col(0)).norm()});
}

// Those that have two edges on a rim, a third inside, and a small angle or no long edge.
std::vector<char> rim_slivers(const TriangleMesh& mesh, const std::vector<Edge>& all, double shortest) {
  std::vector<int> rims(static_cast<size_t>(mesh.triangle_count()), 0);
  for (const Edge& edge : all)
    if (edge.triangles.size() == 1) ++rims[static_cast<size_t>(edge.triangles[0])];
  std::vector<char> is_sliver(rims.size());
  for (size_t t = 0; t < rims.size(); ++t)
    is_sliver[t] = rims[t] == 2 && (least_around(mesh, {static_cast<int>(t)}) < kCutAngle ||
                                    longest_edge(mesh, static_cast<int>(t)) < shortest);
  return is_sliver;
}

void keep_triangles(TriangleMesh& mesh, const std::vector<char>& is_gone) {
  Triangles kept(3, mesh.triangle_count());
  Eigen::Index count = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::Vector3i corners = mesh.triangles.col(t);
    const bool is_flat = corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
    if (!is_flat && is_gone[static_cast<size_t>(t)] == 0) kept.col(count++) = corners;
  }
  mesh.triangles = kept.leftCols(count);
}

// One round; the number of edges that became points.
int collapse_once(TriangleMesh& mesh, double shortest) {
  std::vector<Edge> all = edges(mesh.triangles);
  const Corners corners = corners_of(mesh, all);
  const auto length = [&](const Edge& edge) {
    return (mesh.vertices.col(edge.a) - mesh.vertices.col(edge.b)).norm();
  };
  std::erase_if(all, [&](const Edge& edge) { return length(edge) >= shortest; });
  std::stable_sort(all.begin(), all.end(),
                   [&](const Edge& a, const Edge& b) { return length(a) < length(b); });
  std::vector<char> is_touched(static_cast<size_t>(mesh.vertex_count()), 0);
  int count = 0;
  for (const Edge& edge : all) {
    std::set<int> around = neighbours_of(mesh, corners, edge.a);
    around.merge(neighbours_of(mesh, corners, edge.b));
    if (std::any_of(around.begin(), around.end(),
                    [&](int v) { return is_touched[static_cast<size_t>(v)] != 0; }))
      continue;
    if (!can_collapse(mesh, corners, edge) || !collapse(mesh, corners, edge)) continue;
    ++count;
    for (const int v : around) is_touched[static_cast<size_t>(v)] = 1;
  }
  keep_triangles(mesh, std::vector<char>(static_cast<size_t>(mesh.triangle_count()), 0));
  return count;
}

}  // namespace

void collapse_short_edges(TriangleMesh& mesh, double shortest) {
  for (int round = 0; round < kCollapses; ++round) {
    const int collapsed = collapse_once(mesh, shortest);
    const std::vector<char> slivers = rim_slivers(mesh, edges(mesh.triangles), shortest);
    keep_triangles(mesh, slivers);
    if (collapsed == 0 && std::count(slivers.begin(), slivers.end(), 1) == 0) break;
  }
}

void round_triangles(TriangleMesh& mesh, const TriangleMesh& surface, int rounds) {
  const TriangleTree tree(surface.vertices, surface.triangles);
  const std::vector<Points> rims = rims_of(surface);
  for (int round = 0; round < rounds; ++round) {
    flip_edges(mesh);
    move_vertices(mesh, tree, rims);
  }
}

double least_angle(const TriangleMesh& mesh) {
  double least = 180;
  for (int t = 0; t < mesh.triangle_count(); ++t) least = std::min(least, least_around(mesh, {t}));
  return least;
}

}  // namespace coapt
