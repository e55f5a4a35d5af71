#include "valve/generators/rough_triangles.hpp"

#include "valve/generators/rough_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace coapt {
namespace {

// Twice the area in (u, t), positive for triangles as they should be.
double parameter_area(const RoughTriangles& mesh, int a, int b, int c) {
  auto from_a = [&](int v) {
    Eigen::Vector2d d = mesh.at[v] - mesh.at[a];
    d[0] -= std::round(d[0]);
    return d;
  };
  const Eigen::Vector2d ab = from_a(b), ac = from_a(c);
  return ab[1] * ac[0] - ab[0] * ac[1];
}

Vec3 normal_of(const RoughTriangles& mesh, int a, int b, int c) {
  return (mesh.x[b] - mesh.x[a]).cross(mesh.x[c] - mesh.x[a]).normalized();
}

double aspect_of(const RoughTriangles& mesh, int a, int b, int c) {
  return aspect(mesh.x[a], mesh.x[b], mesh.x[c]);
}

double corner_angle(const RoughTriangles& mesh, int a, int b, int c) {
  const Vec3 ab = mesh.x[b] - mesh.x[a], ac = mesh.x[c] - mesh.x[a];
  return std::atan2(ab.cross(ac).norm(), ab.dot(ac));
}

// An inner edge with its two triangles: (c, a, b) and (d, b, a).
struct Diamond {
  int a, b, c, d, left, right;
};

int corner_beside(const Eigen::Vector3i& t, int a, int b) {
  return *std::find_if(t.begin(), t.end(), [&](int v) { return v != a && v != b; });
}

Diamond diamond_of(const RoughTriangles& mesh, const Edge& edge) {
  const int left = edge.triangles[0], right = edge.triangles[1];
  const Eigen::Vector3i& t = mesh.triangles[left];
  const int c = corner_beside(t, edge.a, edge.b), d = corner_beside(mesh.triangles[right], edge.a, edge.b);
  const auto at_c = std::find(t.begin(), t.end(), c) - t.begin();
  return {t[(at_c + 1) % 3], t[(at_c + 2) % 3], c, d, left, right};
}

// Would the other diagonal leave two triangles that are not turned over, nor folded against each other?
bool can_turn(const RoughTriangles& mesh, const Diamond& d) {
  constexpr double kLeast = 1e-9;
  return parameter_area(mesh, d.c, d.a, d.d) > kLeast && parameter_area(mesh, d.c, d.d, d.b) > kLeast &&
         normal_of(mesh, d.c, d.a, d.d).dot(normal_of(mesh, d.c, d.d, d.b)) > 0.5;
}

void turn(RoughTriangles& mesh, const Diamond& d) {
  mesh.triangles[d.left] = {d.c, d.a, d.d};
  mesh.triangles[d.right] = {d.c, d.d, d.b};
}

// One pass over the edges; each triangle takes part in one flip at most. Returns the number of flips.
int flip_pass(RoughTriangles& mesh) {
  constexpr double kTolerance = 1e-6;
  std::vector<bool> is_touched(mesh.triangles.size(), false);
  int flips = 0;
  for (const Edge& edge : edges(mesh.as_matrix())) {
    if (edge.triangles.size() != 2) continue;
    if (is_touched[edge.triangles[0]] || is_touched[edge.triangles[1]]) continue;
    const Diamond d = diamond_of(mesh, edge);
    const double sum = corner_angle(mesh, d.c, d.a, d.b) + corner_angle(mesh, d.d, d.a, d.b);
    if (sum < std::numbers::pi + kTolerance || !can_turn(mesh, d)) continue;
    turn(mesh, d);
    is_touched[d.left] = is_touched[d.right] = true;
    ++flips;
  }
  return flips;
}

void make_delaunay(RoughTriangles& mesh) {
  constexpr int kPasses = 12;
  for (int pass = 0; pass < kPasses; ++pass)
    if (flip_pass(mesh) == 0) return;
}

// Puts vertex m on an edge: each of its triangles becomes two.
void split(RoughTriangles& mesh, const Edge& edge, int m) {
  for (const int t : edge.triangles) {
    Eigen::Vector3i second = mesh.triangles[t];
    for (int k = 0; k < 3; ++k) {
      if (mesh.triangles[t][k] == edge.a) second[k] = m;
    }
    std::replace(mesh.triangles[t].begin(), mesh.triangles[t].end(), edge.b, m);
    mesh.triangles.push_back(second);
  }
}

double edge_length(const RoughTriangles& mesh, const Edge& edge) {
  return (mesh.x[edge.a] - mesh.x[edge.b]).norm();
}

std::vector<std::vector<int>> triangles_around(const RoughTriangles& mesh) {
  std::vector<std::vector<int>> around(mesh.at.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t]) around[v].push_back(static_cast<int>(t));
  return around;
}

// A vertex between the ends of an edge, or in a triangle, that leaves those around it flat.
int add_vertex(RoughTriangles& mesh, const Eigen::Vector2d& at, const Vec3& x) {
  mesh.at.push_back(at);
  mesh.x.push_back(x);
  return static_cast<int>(mesh.at.size()) - 1;
}

bool is_fine_sliver(double value) { return value > 30 && value < kGreatestAspect; }

// Splits an edge close to one end. False where the triangles would not be what is wanted.
bool add_needle(const Edge& edge, double wanted, bool at_a, RoughTriangles& mesh) {
  const int near = at_a ? edge.a : edge.b, far = at_a ? edge.b : edge.a;
  const double share = 1 / wanted;
  const Vec3 x = mesh.x[near] + share * (mesh.x[far] - mesh.x[near]);
  double worst = 0;
  for (const int t : edge.triangles) {
    const Vec3& beside = mesh.x[corner_beside(mesh.triangles[t], edge.a, edge.b)];
    worst = std::max({worst, aspect(mesh.x[near], x, beside), aspect(x, mesh.x[far], beside)});
  }
  if (!is_fine_sliver(worst)) return false;
  split(mesh, edge, add_vertex(mesh, mesh.coordinates_between(near, far, share), x));
  return true;
}

// Puts a vertex into a triangle, close to its first edge.
bool add_cap(int t, double wanted, RandomSource& random, RoughTriangles& mesh) {
  const Eigen::Vector3i v = mesh.triangles[t];
  const double along = random.between(0.3, 0.7);
  const Vec3 foot = mesh.x[v[0]] + along * (mesh.x[v[1]] - mesh.x[v[0]]);
  const double share = aspect_of(mesh, v[0], v[1], v[2]) / wanted;
  const Vec3 x = foot + share * (mesh.x[v[2]] - foot);
  const double worst = std::max({aspect(mesh.x[v[0]], mesh.x[v[1]], x), aspect(mesh.x[v[1]], mesh.x[v[2]], x),
                                 aspect(mesh.x[v[2]], mesh.x[v[0]], x)});
  if (share > 0.2 || !is_fine_sliver(worst)) return false;
  Eigen::Vector2d at = mesh.coordinates_between(v[0], v[1], along);
  Eigen::Vector2d up = mesh.at[v[2]] - at;
  up[0] -= std::round(up[0]);
  at += share * up;
  const int m = add_vertex(mesh, at, x);
  mesh.triangles[t] = {v[0], v[1], m};
  mesh.triangles.push_back({v[1], v[2], m});
  mesh.triangles.push_back({v[2], v[0], m});
  return true;
}

// A random order of 0 ... count - 1.
std::vector<int> shuffled(int count, RandomSource& random) {
  std::vector<int> order(static_cast<size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  for (int i = count - 1; i > 0; --i) std::swap(order[i], order[random.below(i + 1)]);
  return order;
}

}  // namespace

double aspect(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  const double twice_area = (b - a).cross(c - a).norm();
  return twice_area > 0 ? longest / twice_area : kInfinity;
}

Triangles RoughTriangles::as_matrix() const {
  Triangles all(3, static_cast<int>(triangles.size()));
  for (size_t t = 0; t < triangles.size(); ++t) all.col(static_cast<int>(t)) = triangles[t];
  return all;
}

Eigen::Vector2d RoughTriangles::coordinates_between(int a, int b, double share) const {
  Eigen::Vector2d step = at[b] - at[a];
  step[0] -= std::round(step[0]);
  Eigen::Vector2d between = at[a] + share * step;
  between[0] -= std::floor(between[0]);
  return between;
}

RoughTriangles staggered_strip(const RoughSurface& surface, const std::vector<double>& columns, int rows) {
  RoughTriangles mesh;
  const int n = static_cast<int>(columns.size());
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i < n; ++i) {
      const double next = i + 1 < n ? columns[i + 1] : 1;
      const double u = j % 2 == 0 ? columns[i] : 0.5 * (columns[i] + next), t = double(j) / rows;
      add_vertex(mesh, {u, t}, surface.open(u, t));
    }
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < n; ++i) {
      const int k = (i + 1) % n, a = j * n + i, b = j * n + k, c = a + n, d = b + n;
      if (j % 2 == 0) {
        mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {b, c, d}});
      } else {
        mesh.triangles.insert(mesh.triangles.end(), {{a, c, d}, {a, d, b}});
      }
    }
  return mesh;
}

void refine(const RoughSurface& surface, const std::function<double(const Eigen::Vector2d&)>& density,
            int wanted, RandomSource& random, RoughTriangles& mesh) {
  make_delaunay(mesh);
  while (static_cast<int>(mesh.triangles.size()) < wanted) {
    const std::vector<Edge> all = edges(mesh.as_matrix());
    std::vector<double> urgency;
    for (const Edge& edge : all)
      urgency.push_back(edge_length(mesh, edge) * density(mesh.coordinates_between(edge.a, edge.b, 0.5)) *
                        random.between(0.6, 1.4));
    std::vector<int> order(all.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return urgency[a] > urgency[b] || (urgency[a] == urgency[b] && a < b); });
    const size_t before = mesh.triangles.size();
    std::vector<bool> is_touched(before, false);
    for (size_t i = 0; i < all.size() / 6 + 1 && static_cast<int>(mesh.triangles.size()) < wanted; ++i) {
      const Edge& edge = all[order[i]];
      if (std::any_of(edge.triangles.begin(), edge.triangles.end(), [&](int t) { return is_touched[t]; }))
        continue;
      for (const int t : edge.triangles) is_touched[t] = true;
      const Eigen::Vector2d at = mesh.coordinates_between(edge.a, edge.b, random.between(0.35, 0.65));
      split(mesh, edge, add_vertex(mesh, at, surface.open(at[0], at[1])));
    }
    make_delaunay(mesh);
  }
}

void jitter(const RoughSurface& surface, const std::vector<int>& held, double size, RandomSource& random,
            RoughTriangles& mesh) {
  constexpr double kMostAspect = 20, kLeast = 1e-9;
  const std::vector<std::vector<int>> around = triangles_around(mesh);
  for (int v = 0; v < static_cast<int>(mesh.at.size()); ++v) {
    if (std::find(held.begin(), held.end(), v) != held.end()) continue;
    const Eigen::Vector3i& t = mesh.triangles[around[v][random.below(static_cast<int>(around[v].size()))]];
    const auto here = std::find(t.begin(), t.end(), v) - t.begin();
    const int a = t[(here + 1) % 3], b = t[(here + 2) % 3];
    const Eigen::Vector2d old_at = mesh.at[v];
    const Vec3 old_x = mesh.x[v];
    const double share = size * random.unit(), side = random.unit();
    Eigen::Vector2d to = mesh.coordinates_between(a, b, side) - old_at;
    to[0] -= std::round(to[0]);
    if (old_at[1] == 0 || old_at[1] == 1) to[1] = 0;
    std::vector<Vec3> normals;
    for (const int k : around[v]) {
      const Eigen::Vector3i& s = mesh.triangles[k];
      normals.push_back(normal_of(mesh, s[0], s[1], s[2]));
    }
    mesh.at[v] += share * to;
    mesh.at[v][0] -= std::floor(mesh.at[v][0]);
    mesh.x[v] = surface.open(mesh.at[v][0], mesh.at[v][1]);
    bool is_fine = true;
    for (size_t i = 0; i < normals.size(); ++i) {
      const Eigen::Vector3i& s = mesh.triangles[around[v][i]];
      is_fine &= parameter_area(mesh, s[0], s[1], s[2]) > kLeast &&
                 aspect_of(mesh, s[0], s[1], s[2]) < kMostAspect &&
                 normal_of(mesh, s[0], s[1], s[2]).dot(normals[i]) > 0.6;
    }
    if (is_fine) continue;
    mesh.at[v] = old_at;
    mesh.x[v] = old_x;
  }
}

void turn_edges(double share, double most, RandomSource& random, RoughTriangles& mesh) {
  std::vector<bool> is_touched(mesh.triangles.size(), false);
  for (const Edge& edge : edges(mesh.as_matrix())) {
    const bool is_chosen = random.chance(share);
    if (!is_chosen || edge.triangles.size() != 2) continue;
    if (is_touched[edge.triangles[0]] || is_touched[edge.triangles[1]]) continue;
    const Diamond d = diamond_of(mesh, edge);
    if (!can_turn(mesh, d) || aspect_of(mesh, d.c, d.a, d.d) > most || aspect_of(mesh, d.c, d.d, d.b) > most)
      continue;
    turn(mesh, d);
    is_touched[d.left] = is_touched[d.right] = true;
  }
}

void add_slivers(int count, RandomSource& random, RoughTriangles& mesh) {
  const std::vector<Edge> all = edges(mesh.as_matrix());
  std::vector<bool> is_touched(mesh.triangles.size(), false);
  int added = 0;
  for (const int i : shuffled(static_cast<int>(all.size()), random)) {
    if (added >= count) return;
    const Edge& edge = all[i];
    if (std::any_of(edge.triangles.begin(), edge.triangles.end(), [&](int t) { return is_touched[t]; }))
      continue;
    const double wanted = random.log_between(30, kGreatestAspect);
    const bool is_needle = random.chance(0.6), at_a = random.chance(0.5);
    const bool is_added =
        is_needle ? add_needle(edge, wanted, at_a, mesh) : add_cap(edge.triangles[0], wanted, random, mesh);
    if (!is_added) continue;
    for (const int t : edge.triangles) is_touched[t] = true;
    ++added;
  }
}

}  // namespace coapt
