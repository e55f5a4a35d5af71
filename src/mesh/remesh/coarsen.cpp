#include "mesh/remesh/coarsen.hpp"

#include "mesh/distance/triangle_distance.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

namespace coapt {
namespace {

using Corners = Eigen::Vector3i;

constexpr size_t kMostNeighbours = 9;    // of a vertex, after a collapse or a flip
constexpr size_t kLeastTriangles = 4;    // around an inner vertex that loses one
constexpr double kLongest = 1.75;        // new edge over the mean one of the wanted mesh
constexpr double kLeastQuality = 0.3;    // of a new triangle, or no worse than the worst before
constexpr double kNormalCosine = 0.5;    // between the normals of a triangle before and after
constexpr double kLineCosine = 0.6;      // between the two edges of a line at a vertex that may go
constexpr double kFlatCosine = 0.8;      // between the normals at an edge that may be flipped
constexpr double kDelaunaySlack = 0.05;  // of the cotangents' sum, so that no edge is flipped to and fro
constexpr double kLeastProgress = 0.02;  // share of the triangles that a round must remove

template <typename T>
T& at(std::vector<T>& list, int i) {
  return list[static_cast<size_t>(i)];
}
template <typename T>
const T& at(const std::vector<T>& list, int i) {
  return list[static_cast<size_t>(i)];
}

bool has_corner(const Corners& t, int v) { return t[0] == v || t[1] == v || t[2] == v; }

// 1 for an equilateral triangle, 0 for one without area.
double quality(const Vec3& a, const Vec3& b, const Vec3& c, double area_doubled) {
  const double sum = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return sum > 0 ? 2 * std::sqrt(3.0) * area_doubled / sum : 0;
}

// What collapses of a vertex have in common: its neighbours, and its triangles before.
struct Star {
  std::vector<int> ring;
  std::vector<Vec3> normals;  // of the triangles in the order of `around_`, length twice the area
  double worst = 1;           // quality of its triangles
};

// One vertex may go into the other.
struct Collapse {
  double cost = 0;
  int vertex = 0, into = 0;
};

class Coarsener {
 public:
  Coarsener(const TriangleMesh& mesh, const CoarsenOptions& options)
      : x_(mesh.vertices),
        regions_(mesh.regions),
        triangle_count_(mesh.triangle_count()),
        around_(static_cast<size_t>(mesh.vertex_count())),
        line_(around_.size(), {-1, -1}),
        is_locked_(around_.size(), false),
        size_(Vector::Zero(mesh.vertex_count())),
        longest_squared_(kLongest * kLongest / options.share),
        mark_(around_.size(), 0),
        second_mark_(around_.size(), 0) {
    for (int t = 0; t < triangle_count_; ++t) {
      triangles_.push_back(mesh.triangles.col(t));
      for (int k = 0; k < 3; ++k) at(around_, mesh.triangles(k, t)).push_back(t);
    }
    guests_.resize(triangles_.size());
    lay_lines(mesh, options);
    lock(options);
  }

  int triangle_count() const { return triangle_count_; }

  void run(int wanted) {
    while (triangle_count_ > wanted) {
      const int before = triangle_count_;
      collapse_round(wanted);
      flip_round();
      if (before - triangle_count_ < kLeastProgress * before) break;
    }
  }

  Coarsening result(const TriangleMesh& fine) const;

 private:
  void lay_lines(const TriangleMesh& mesh, const CoarsenOptions& options);
  void lock(const CoarsenOptions& options);
  void add_line(int a, int b);
  bool is_on_line(int v) const { return at(line_, v)[0] >= 0; }
  bool is_line(int a, int b) const { return at(line_, a)[0] == b || at(line_, a)[1] == b; }
  const std::vector<int>& ring(int v);
  void look_at(int v);

  std::optional<Collapse> best_collapse(int v);
  std::optional<double> cost_of(int v, int u, double most);
  bool keeps_manifold(int v, int u);
  void collapse_round(int wanted);
  void collapse(int v, int u);
  void flip_round();
  bool flip(int t, int k);
  void rehouse(const std::vector<int>& homeless, const std::vector<int>& homes);

  Vec3 normal(const Corners& t) const {
    return (x_.col(t[1]) - x_.col(t[0])).cross(x_.col(t[2]) - x_.col(t[0]));
  }

  const Points& x_;
  const std::vector<int>& regions_;
  int triangle_count_;
  std::vector<Corners> triangles_;        // -1 in the first place: gone
  std::vector<std::vector<int>> around_;  // triangles of each vertex
  std::vector<std::vector<int>> guests_;  // vertices that are gone, by triangle
  std::vector<std::array<int, 2>> line_;  // neighbours along the line that a vertex is on; -1: none
  std::vector<char> is_locked_;
  std::vector<int> kinds_;
  Vector size_;             // mean length of the edges at each vertex in the fine mesh
  double longest_squared_;  // of new edges, relative to those of the fine mesh
  Star star_;               // of the vertex that is looked at
  std::vector<int> mark_, second_mark_;
  int stamp_ = 0, second_stamp_ = 0;
};

// A vertex where more than two edges of lines meet stays.
void Coarsener::add_line(int a, int b) {
  for (const auto& [from, to] : {std::array{a, b}, std::array{b, a}}) {
    auto& ends = at(line_, from);
    if (ends[0] == to || ends[1] == to) continue;
    if (ends[0] < 0)
      ends[0] = to;
    else if (ends[1] < 0)
      ends[1] = to;
    else
      at(is_locked_, from) = true;
  }
}

void Coarsener::lay_lines(const TriangleMesh& mesh, const CoarsenOptions& options) {
  Vector count = Vector::Zero(mesh.vertex_count());
  for (const Edge& edge : edges(mesh.triangles)) {
    const double length = (x_.col(edge.a) - x_.col(edge.b)).norm();
    for (const int v : {edge.a, edge.b}) {
      size_[v] += length;
      count[v] += 1;
    }
    const auto& sides = edge.triangles;
    const bool is_border =
        sides.size() == 2 && !regions_.empty() && at(regions_, sides[0]) != at(regions_, sides[1]);
    if (sides.size() == 1 || is_border) add_line(edge.a, edge.b);
    if (sides.size() > 2 || edge.a == edge.b)
      for (const int v : {edge.a, edge.b}) at(is_locked_, v) = true;
  }
  size_ = size_.cwiseQuotient(count.cwiseMax(1));
  for (const auto& [a, b] : options.lines) add_line(a, b);
}

void Coarsener::lock(const CoarsenOptions& options) {
  kinds_ = options.kinds.empty() ? std::vector<int>(around_.size(), 0) : options.kinds;
  for (const int v : options.keep) at(is_locked_, v) = true;
  for (int v = 0; v < static_cast<int>(around_.size()); ++v) {
    const auto& ends = at(line_, v);
    const int kind = at(kinds_, v);
    bool stays = around_[static_cast<size_t>(v)].empty();
    if (ends[0] >= 0)
      stays = stays || ends[1] < 0 || at(kinds_, ends[0]) != kind || at(kinds_, ends[1]) != kind;
    else if (kind != 0)
      for (const int w : ring(v)) stays = stays || at(kinds_, w) != kind;
    if (stays) at(is_locked_, v) = true;
  }
}

// Neighbours of v, each once, and marked.
const std::vector<int>& Coarsener::ring(int v) {
  std::vector<int>& result = star_.ring;
  result.clear();
  ++stamp_;
  for (const int t : at(around_, v))
    for (int k = 0; k < 3; ++k) {
      const int w = at(triangles_, t)[k];
      if (w == v || at(mark_, w) == stamp_) continue;
      at(mark_, w) = stamp_;
      result.push_back(w);
    }
  return result;
}

void Coarsener::look_at(int v) {
  ring(v);
  star_.normals.clear();
  star_.worst = 1;
  for (const int t : at(around_, v)) {
    const Corners& c = at(triangles_, t);
    star_.normals.push_back(normal(c));
    star_.worst =
        std::min(star_.worst, quality(x_.col(c[0]), x_.col(c[1]), x_.col(c[2]), star_.normals.back().norm()));
  }
}

std::optional<Collapse> Coarsener::best_collapse(int v) {
  if (at(is_locked_, v)) return std::nullopt;
  look_at(v);
  Collapse best{kInfinity, v, -1};
  for (const int u : star_.ring) {
    if (is_on_line(v) && !is_line(v, u)) continue;
    if (at(kinds_, v) != 0 && at(kinds_, u) != at(kinds_, v)) continue;
    const std::optional<double> cost = cost_of(v, u, best.cost);
    if (cost && std::tie(*cost, u) < std::tie(best.cost, best.into)) best = {*cost, v, u};
  }
  return best.into < 0 ? std::nullopt : std::optional(best);
}

// Nothing where the collapse is not admitted, or costs more than `most`. Pre: v is looked at.
std::optional<double> Coarsener::cost_of(int v, int u, double most) {
  double longest = 0;
  for (const int w : star_.ring)
    if (w != u) longest = std::max(longest, (x_.col(w) - x_.col(u)).squaredNorm() / (size_[u] * size_[w]));
  if (longest > std::min(most, longest_squared_) || !keeps_manifold(v, u)) return std::nullopt;
  if (is_on_line(v)) {
    const auto& ends = at(line_, v);
    const Vec3 to = x_.col(u) - x_.col(v), from = x_.col(v) - x_.col(ends[0] == u ? ends[1] : ends[0]);
    if (to.dot(from) < kLineCosine * to.norm() * from.norm()) return std::nullopt;
  }
  double worst = 1;
  for (size_t k = 0; k < star_.normals.size(); ++k) {
    Corners corners = at(triangles_, at(around_, v)[k]);
    if (has_corner(corners, u)) continue;
    for (int c = 0; c < 3; ++c)
      if (corners[c] == v) corners[c] = u;
    const Vec3 after = normal(corners);
    const double doubled = after.norm();
    if (after.dot(star_.normals[k]) <= kNormalCosine * doubled * star_.normals[k].norm()) return std::nullopt;
    worst = std::min(worst, quality(x_.col(corners[0]), x_.col(corners[1]), x_.col(corners[2]), doubled));
  }
  if (worst < std::min(kLeastQuality, star_.worst)) return std::nullopt;
  return longest / worst;
}

// The surface stays manifold when the two vertices have no neighbour in common but across their own
// triangles; besides, no vertex may end up with too many or too few triangles. Pre: v is looked at.
bool Coarsener::keeps_manifold(int v, int u) {
  size_t common = 0, neighbours_of_u = 0, shared = 0;
  ++second_stamp_;
  for (const int t : at(around_, u)) {
    const Corners& corners = at(triangles_, t);
    if (has_corner(corners, v)) {
      ++shared;
      const int apex = corners.sum() - u - v;
      const size_t left = at(around_, apex).size() - 1;
      if (left < (is_on_line(apex) ? 2 : kLeastTriangles)) return false;
    }
    for (int k = 0; k < 3; ++k) {
      const int w = corners[k];
      if (w == u || at(second_mark_, w) == second_stamp_) continue;
      at(second_mark_, w) = second_stamp_;
      ++neighbours_of_u;
      if (at(mark_, w) == stamp_) ++common;
    }
  }
  if (!is_on_line(v) && shared != 2) return false;
  if (at(around_, v).size() == shared) return false;  // nothing would be left of a corner
  return common == shared && neighbours_of_u + star_.ring.size() - common - 2 <= kMostNeighbours;
}

void Coarsener::collapse_round(int wanted) {
  std::vector<Collapse> candidates;
  for (int v = 0; v < static_cast<int>(around_.size()); ++v)
    if (!at(around_, v).empty())
      if (const auto candidate = best_collapse(v)) candidates.push_back(*candidate);
  std::sort(candidates.begin(), candidates.end(), [](const Collapse& l, const Collapse& r) {
    return std::tie(l.cost, l.vertex) < std::tie(r.cost, r.vertex);
  });
  std::vector<char> is_touched(around_.size(), false);
  for (const Collapse& candidate : candidates) {
    if (triangle_count_ <= wanted) return;
    if (at(is_touched, candidate.vertex) || at(is_touched, candidate.into)) continue;
    // A neighbour that was touched may have changed what the cost was computed from.
    look_at(candidate.vertex);
    if (!cost_of(candidate.vertex, candidate.into, kInfinity)) continue;
    for (const int w : star_.ring) at(is_touched, w) = true;
    collapse(candidate.vertex, candidate.into);
  }
}

void Coarsener::collapse(int v, int u) {
  std::vector<int> homeless{v}, homes;
  for (const int t : at(around_, v)) {
    Corners& corners = at(triangles_, t);
    std::vector<int>& guests = at(guests_, t);
    homeless.insert(homeless.end(), guests.begin(), guests.end());
    guests.clear();
    if (has_corner(corners, u)) {
      for (int k = 0; k < 3; ++k)
        if (corners[k] != v) std::erase(at(around_, corners[k]), t);
      corners[0] = -1;
      --triangle_count_;
      continue;
    }
    for (int k = 0; k < 3; ++k)
      if (corners[k] == v) corners[k] = u;
    at(around_, u).push_back(t);
    homes.push_back(t);
  }
  at(around_, v).clear();
  if (is_on_line(v)) {
    const auto& ends = at(line_, v);
    const int other = ends[0] == u ? ends[1] : ends[0];
    std::replace(at(line_, u).begin(), at(line_, u).end(), v, other);
    std::replace(at(line_, other).begin(), at(line_, other).end(), v, u);
  }
  rehouse(homeless, homes);
}

// Puts each vertex into the triangle that is closest to it.
void Coarsener::rehouse(const std::vector<int>& homeless, const std::vector<int>& homes) {
  for (const int guest : homeless) {
    int best = homes.front();
    double nearest = kInfinity;
    for (const int t : homes) {
      const Corners& c = at(triangles_, t);
      const double distance =
          closest_on_triangle(x_.col(guest), x_.col(c[0]), x_.col(c[1]), x_.col(c[2])).distance_squared;
      if (distance < nearest) std::tie(nearest, best) = std::tuple(distance, t);
    }
    at(guests_, best).push_back(guest);
  }
}

void Coarsener::flip_round() {
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
    for (int k = 0; k < 3; ++k)
      if (at(triangles_, t)[0] >= 0 && flip(t, k)) break;
}

// Flips the edge from corner k of t where the angles opposite it are too large.
bool Coarsener::flip(int t, int k) {
  Corners& first = at(triangles_, t);
  const int a = first[k], b = first[(k + 1) % 3], c = first[(k + 2) % 3];
  // Where more than two lines meet, the vertex does not know them all.
  if (is_line(a, b) || is_line(b, a) || (at(is_locked_, a) && at(is_locked_, b))) return false;
  int s = -1;
  for (const int other : at(around_, a))
    if (other != t && has_corner(at(triangles_, other), b)) {
      if (s >= 0) return false;  // not manifold
      s = other;
    }
  if (s < 0 || (!regions_.empty() && at(regions_, s) != at(regions_, t))) return false;
  Corners& second = at(triangles_, s);
  const int d = second.sum() - a - b;
  const Vec3 n1 = normal(first), n2 = normal(second);
  const auto cotangent = [&](int apex, const Vec3& n) {
    return (x_.col(a) - x_.col(apex)).dot(x_.col(b) - x_.col(apex)) / n.norm();
  };
  if (!(cotangent(c, n1) + cotangent(d, n2) < -kDelaunaySlack)) return false;
  if (n1.dot(n2) < kFlatCosine * n1.norm() * n2.norm()) return false;
  for (const int v : {a, b})
    if (at(around_, v).size() <= (is_on_line(v) ? 2 : kLeastTriangles)) return false;
  for (const int v : {c, d})
    if (at(around_, v).size() >= kMostNeighbours) return false;
  for (const int other : at(around_, c))
    if (has_corner(at(triangles_, other), d)) return false;
  const Corners one(a, d, c), two(d, b, c);
  for (const Corners& fresh : {one, two}) {
    const Vec3 n = normal(fresh);
    if (n.dot(n1) <= kNormalCosine * n.norm() * n1.norm()) return false;
    if (n.dot(n2) <= kNormalCosine * n.norm() * n2.norm()) return false;
  }
  first = one;
  second = two;
  std::erase(at(around_, b), t);
  std::erase(at(around_, a), s);
  at(around_, d).push_back(t);
  at(around_, c).push_back(s);
  std::vector<int> homeless = std::move(at(guests_, t));
  homeless.insert(homeless.end(), at(guests_, s).begin(), at(guests_, s).end());
  at(guests_, t).clear();
  at(guests_, s).clear();
  rehouse(homeless, {t, s});
  return true;
}

Coarsening Coarsener::result(const TriangleMesh& fine) const {
  Coarsening result;
  std::vector<char> is_gone(around_.size(), false);
  for (const auto& guests : guests_)
    for (const int v : guests) at(is_gone, v) = true;
  result.number.assign(around_.size(), -1);
  for (int v = 0; v < fine.vertex_count(); ++v) {
    if (at(is_gone, v)) continue;
    at(result.number, v) = static_cast<int>(result.kept.size());
    result.kept.push_back(v);
  }
  for (const int v : result.kept)
    for (const int w : at(line_, v))
      if (w > v || (w >= 0 && !is_line(w, v)))
        result.lines.push_back({at(result.number, v), at(result.number, w)});
  result.mesh.vertices = x_(Eigen::all, result.kept);
  result.mesh.region_names = fine.region_names;
  result.mesh.triangles.resize(3, triangle_count_);
  result.host.assign(around_.size(), -1);
  result.weights = Points::Zero(3, fine.vertex_count());
  int next = 0;
  for (int t = 0; t < fine.triangle_count(); ++t) {
    const Corners& c = at(triangles_, t);
    if (c[0] < 0) continue;
    for (int k = 0; k < 3; ++k) result.mesh.triangles(k, next) = at(result.number, c[k]);
    if (!regions_.empty()) result.mesh.regions.push_back(at(regions_, t));
    for (const int guest : at(guests_, t)) {
      at(result.host, guest) = next;
      result.weights.col(guest) =
          closest_on_triangle(x_.col(guest), x_.col(c[0]), x_.col(c[1]), x_.col(c[2])).weights;
    }
    ++next;
  }
  return result;
}

}  // namespace

Coarsening coarsen(const TriangleMesh& mesh, const CoarsenOptions& options) {
  Coarsener coarsener(mesh, options);
  coarsener.run(static_cast<int>(std::ceil(options.share * mesh.triangle_count())));
  return coarsener.result(mesh);
}

}  // namespace coapt
