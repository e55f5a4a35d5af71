#include "mesh/remesh/coarsen.hpp"

#include "core/bounded_int.hpp"
#include "mesh/distance/triangle_distance.hpp"
#include "mesh/remesh/detail/coarsener.hpp"
#include "mesh/remesh/detail/order_of_place.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace coapt {
namespace coarsening {
namespace {

constexpr double kLongest = 1.75;        // new edge over the mean one of the wanted mesh
constexpr double kFlatCosine = 0.8;      // between the normals at an edge that may be flipped
constexpr double kDelaunaySlack = 0.05;  // of the cotangents' sum, so that no edge is flipped to and fro
constexpr double kLeastProgress = 0.02;  // share of the triangles that a round must remove

}  // namespace

Coarsener::Coarsener(const TriangleMesh& mesh, const CoarsenOptions& options)
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

void Coarsener::run(int wanted) {
  while (triangle_count_ > wanted) {
    const int before = triangle_count_;
    collapse_round(wanted);
    flip_round();
    if (before - triangle_count_ < kLeastProgress * before) break;
  }
}

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

// The worst edges first, so that the order of triangles does not decide which are flipped.
void Coarsener::flip_round() {
  struct Candidate {
    double excess;  // of the angles opposite the edge, as the sum of their cotangents
    int a, b;
  };
  std::vector<Candidate> candidates;
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
    for (int k = 0; k < 3 && at(triangles_, t)[0] >= 0; ++k) {
      const int a = at(triangles_, t)[k], b = at(triangles_, t)[(k + 1) % 3];
      const int s = across(t, a, b);
      if (s < 0) continue;
      const double excess = opposite_cotangents(t, s, a, b);
      if (excess < -kDelaunaySlack) candidates.push_back({excess, a, b});
    }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& l, const Candidate& r) {
    return std::tie(l.excess, l.a, l.b) < std::tie(r.excess, r.a, r.b);
  });
  for (const auto& [excess, a, b] : candidates)
    for (const int t : at(around_, a)) {
      const Corners& corners = at(triangles_, t);
      int k = 0;
      while (k < 3 && (corners[k] != a || corners[(k + 1) % 3] != b)) ++k;
      if (k == 3) continue;
      flip(t, k);
      break;
    }
}

// The other triangle at an edge of t; -1: none, -2: more than one.
int Coarsener::across(int t, int a, int b) const {
  int found = -1;
  for (const int other : at(around_, a))
    if (other != t && has_corner(at(triangles_, other), b)) found = found == -1 ? other : -2;
  return found;
}

// Of the angles of t and s opposite their common edge; negative where they add up to more than 180 degrees.
double Coarsener::opposite_cotangents(int t, int s, int a, int b) const {
  double sum = 0;
  for (const int triangle : {t, s}) {
    const int apex = at(triangles_, triangle).sum() - a - b;
    sum += (x_.col(a) - x_.col(apex)).dot(x_.col(b) - x_.col(apex)) / normal(at(triangles_, triangle)).norm();
  }
  return sum;
}

// Flips the edge from corner k of t where the angles opposite it are too large.
bool Coarsener::flip(int t, int k) {
  Corners& first = at(triangles_, t);
  const int a = first[k], b = first[(k + 1) % 3], c = first[(k + 2) % 3];
  // Where more than two lines meet, the vertex does not know them all.
  if (is_line(a, b) || is_line(b, a) || (at(is_locked_, a) && at(is_locked_, b))) return false;
  const int s = across(t, a, b);
  if (s < 0 || (!regions_.empty() && at(regions_, s) != at(regions_, t))) return false;
  Corners& second = at(triangles_, s);
  const int d = second.sum() - a - b;
  const Vec3 n1 = normal(first), n2 = normal(second);
  if (!(opposite_cotangents(t, s, a, b) < -kDelaunaySlack)) return false;
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

}  // namespace coarsening

Coarsening coarsen(const TriangleMesh& mesh, const CoarsenOptions& options) {
  const coarsening::OrderedMesh ordered = coarsening::in_order_of_place(mesh, options);
  coarsening::Coarsener coarsener(ordered.mesh, ordered.options);
  coarsener.run(bounded_int(std::ceil(options.share * mesh.triangle_count()), 0, mesh.triangle_count()));
  return coarsening::renumbered(coarsener.result(ordered.mesh), ordered, mesh);
}

}  // namespace coapt
