#include "energy/contact/contact_surface.hpp"

#include "mesh/triangle_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace coapt {
namespace {

// Four numbers that are compared at once.
using Four [[gnu::vector_size(16)]] = float;
using Mask [[gnu::vector_size(16)]] = int;

bool all_of(const Mask& mask) {
  std::uint64_t halves[2];
  std::memcpy(halves, &mask, sizeof halves);
  return (halves[0] & halves[1]) == ~std::uint64_t{0};
}

// Four intervals in single precision, in units of the scene's extent.
struct Intervals {
  static constexpr Four kFar = {1e30F, 1e30F, 1e30F, 1e30F};
  Four low = kFar, high = -kFar;  // empty

  void include(const Intervals& other) {
    low = other.low < low ? other.low : low;
    high = other.high > high ? other.high : high;
  }
};

bool intersect(const Intervals& a, const Intervals& b) {
  return all_of((a.low <= b.high) & (b.low <= a.high));
}

// An axis-aligned box, whose fourth intervals overlap where anything in either moves, cut off by the planes
// across the four diagonals of a cube: a polytope of 14 faces (Klosowski et al. 1998). A box alone is wide
// around what lies aslant, as most of a valve does.
struct NearBox {
  Intervals box, diagonals;

  void include(const NearBox& other) {
    box.include(other.box);
    diagonals.include(other.diagonals);
  }
};

// What a search spends its time on.
bool overlap(const NearBox& a, const NearBox& b) {
  return intersect(a.box, b.box) && intersect(a.diagonals, b.diagonals);
}

// A box, and the box of the displacements of what is in it over the whole way, whose fourth number is
// positive where anything in it is searched around.
struct SweptBox {
  Intervals at, move;

  void include(const SweptBox& other) {
    at.include(other.at);
    move.include(other.move);
  }
};

// Whether some point of b - a + s (move of b - move of a) can be zero for one s in [0, share of the way]:
// along each axis the relative positions form an interval whose ends move linearly, and the times at which it
// holds zero are an interval too. What moves alike, such as neighbours on the surface, is so told apart
// however far it goes.
bool may_meet(const SweptBox& a, const SweptBox& b, float share) {
  constexpr float kAmple = 1 + 1e-5F;  // on a time: beyond round-off
  constexpr Four kNever = {1e30F, 1e30F, 1e30F, 1e30F}, kZero = {};
  if (!(a.move.high[3] > 0) && !(b.move.high[3] > 0)) return false;
  const Four low = b.at.low - a.at.high, high = b.at.high - a.at.low;
  const Four low_rate = b.move.low - a.move.high, high_rate = b.move.high - a.move.low;
  const Four low_zero = -low / low_rate, high_zero = -high / high_rate, end = {share, share, share, share};
  const Four from = low > 0    ? (low_rate < 0 ? low_zero : kNever)
                    : high < 0 ? (high_rate > 0 ? high_zero : kNever)
                               : kZero;
  const Four low_end = ((low <= 0) & (low_rate > 0)) ? low_zero : end,
             high_end = ((high >= 0) & (high_rate < 0)) ? high_zero : end,
             to = low_end < high_end ? low_end : high_end;
  return !(std::max({from[0], from[1], from[2]}) > kAmple * std::min({to[0], to[1], to[2]}));
}

// Makes boxes around nodes.
class NearBoxes {
 public:
  // around: the triangles around each node; the scene is as large as the nodes that have some.
  NearBoxes(const Points& x, double reach, const std::vector<std::vector<int>>& around) : x_(x) {
    Bounds all;
    for (size_t node = 0; node < around.size(); ++node)
      if (!around[node].empty()) all.include(Vec3(x.col(static_cast<Eigen::Index>(node))));
    origin_ = all.low.matrix();
    const double extent = (all.high - all.low).maxCoeff();
    scale_ =
        std::isfinite(extent) ? (extent > 0 ? 1 / extent : 0) : kNaN;  // nothing is near what is not finite
    half_ = static_cast<float>(std::min(0.5 * reach * scale_, 2.0)) + kRounding;
  }
  NearBox near(int node, bool moves) const {
    constexpr float kRoot3 = 1.7320509F;
    const Four at = point(node), half = {kRoot3 * half_, kRoot3 * half_, kRoot3 * half_, kRoot3 * half_};
    const Four along = {at[0] + at[1] + at[2], at[0] + at[1] - at[2], at[0] - at[1] + at[2],
                        at[1] + at[2] - at[0]};
    return {box(at, moves), {along - half, along + half}};
  }
  // way: of the node. One that is not finite, or that single precision does not hold, may lead anywhere.
  SweptBox swept(int node, const Vec3& way, bool is_searched) const {
    const Eigen::Vector3f by = (scale_ * way).cast<float>();
    const float searched = is_searched ? 1.0F : -1.0F;
    Intervals move{-Intervals::kFar, Intervals::kFar};
    if (by.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() < Intervals::kFar[0]) {
      const Four step = {by[0], by[1], by[2], 0}, half = kRounding * (step < 0 ? -step : step);
      move = {step - half, step + half};
    }
    move.low[3] = -searched;
    move.high[3] = searched;
    return {box(point(node), true), move};
  }

 private:
  Four point(int node) const {
    const Eigen::Vector3f at = (scale_ * (x_.col(node) - origin_)).cast<float>();
    return Four{at[0], at[1], at[2], 0};
  }
  Intervals box(const Four& at, bool moves) const {
    const Four half = {half_, half_, half_, moves ? 2.0f : -1.0f};
    return {at - half, at + half};
  }

  static constexpr float kRounding = 1e-6F;  // of the extent: of the coordinates and of the sums with them

  const Points& x_;
  Vec3 origin_ = Vec3::Zero();
  double scale_ = 0;
  float half_ = 0;
};

}  // namespace

ContactSurface::ContactSurface(const Points& rest, Triangles triangles, int membrane_count,
                               std::vector<std::array<int, 2>> excluded)
    : rest_(rest),
      triangles_(std::move(triangles)),
      excluded_(std::move(excluded)),
      vertex_area_(static_cast<size_t>(rest.cols()), 0),
      around_(static_cast<size_t>(rest.cols())),
      own_vertices_(static_cast<size_t>(triangles_.cols())),
      own_edges_(static_cast<size_t>(triangles_.cols())),
      hierarchy_(centroids(rest, triangles_), membrane_count) {
  for (auto& [s, t] : excluded_)
    if (s > t) std::swap(s, t);
  std::sort(excluded_.begin(), excluded_.end());
  std::vector<double> third(static_cast<size_t>(triangles_.cols()));
  for (int t = 0; t < triangles_.cols(); ++t) {
    third[static_cast<size_t>(t)] = area_vector(rest_, triangles_.col(t)).norm() / 3;
    for (int k = 0; k < 3; ++k) {
      const size_t node = static_cast<size_t>(triangles_(k, t));
      if (around_[node].empty()) own_vertices_[static_cast<size_t>(t)].push_back(static_cast<int>(node));
      around_[node].push_back(t);
      vertex_area_[node] += third[static_cast<size_t>(t)];
    }
  }
  for (const Edge& edge : edges(triangles_)) {
    double area = 0;
    for (const int t : edge.triangles) area += third[static_cast<size_t>(t)];
    own_edges_[static_cast<size_t>(edge.triangles.front())].push_back(static_cast<int>(edges_.size()));
    edges_.push_back({edge.a, edge.b, area, edge.triangles});
  }
}

double ContactSurface::area(const FeaturePair& pair) const {
  const size_t first = static_cast<size_t>(pair.first), second = static_cast<size_t>(pair.second);
  if (pair.kind == PairKind::EdgeEdge) return std::min(edges_[first].area, edges_[second].area);
  return std::min(vertex_area_[first], area_vector(rest_, triangles_.col(pair.second)).norm());
}

bool ContactSurface::is_excluded(const std::vector<int>& around_first,
                                 const std::vector<int>& around_second) const {
  for (const int s : around_first)
    for (const int t : around_second)
      if (!std::binary_search(excluded_.begin(), excluded_.end(),
                              std::array<int, 2>{std::min(s, t), std::max(s, t)}))
        return false;
  return true;
}

// bound_of_node: Bound of one node.
template <class Bound, class BoundOfNode>
ContactSurface::FeatureBounds<Bound> ContactSurface::feature_bounds(const BoundOfNode& bound_of_node,
                                                                    bool with_edges) const {
  FeatureBounds<Bound> of;
  of.nodes.resize(around_.size());
  of.triangles.resize(static_cast<size_t>(triangles_.cols()));
  for (size_t node = 0; node < around_.size(); ++node)
    if (!around_[node].empty()) of.nodes[node] = bound_of_node(static_cast<int>(node));
  for (int t = 0; t < triangles_.cols(); ++t)
    for (int k = 0; k < 3; ++k)
      of.triangles[static_cast<size_t>(t)].include(of.nodes[static_cast<size_t>(triangles_(k, t))]);
  hierarchy_.fit(of.triangles, of.tree);
  of.edges.reserve(edges_.size());
  if (with_edges)
    for (const SurfaceEdge& edge : edges_) {
      of.edges.push_back(of.nodes[static_cast<size_t>(edge.a)]);
      of.edges.back().include(of.nodes[static_cast<size_t>(edge.b)]);
    }
  return of;
}

// The pairs that two triangles own. Without bounds of edges: vertices and triangles alone.
template <class Bound, class IsNear, class AnyVisit>
void ContactSurface::visit_features(int s, int t, const FeatureBounds<Bound>& of, const IsNear& is_near,
                                    const AnyVisit& visit) const {
  const auto visit_points = [&](int from, int to) {
    const int a = triangles_(0, to), b = triangles_(1, to), c = triangles_(2, to);
    for (const int p : own_vertices_[static_cast<size_t>(from)]) {
      if (p == a || p == b || p == c ||
          !is_near(of.nodes[static_cast<size_t>(p)], of.triangles[static_cast<size_t>(to)]))
        continue;
      if (!excluded_.empty() && is_excluded(around_[static_cast<size_t>(p)], {to})) continue;
      visit(FeaturePair{PairKind::PointTriangle, {p, a, b, c}, p, to});
    }
  };
  visit_points(s, t);
  visit_points(t, s);
  if (of.edges.empty()) return;
  for (const int e : own_edges_[static_cast<size_t>(s)]) {
    const SurfaceEdge& first = edges_[static_cast<size_t>(e)];
    for (const int f : own_edges_[static_cast<size_t>(t)]) {
      const SurfaceEdge& second = edges_[static_cast<size_t>(f)];
      if (first.a == second.a || first.a == second.b || first.b == second.a || first.b == second.b) continue;
      if (!is_near(of.edges[static_cast<size_t>(e)], of.edges[static_cast<size_t>(f)])) continue;
      if (!excluded_.empty() && is_excluded(first.triangles, second.triangles)) continue;
      visit(FeaturePair{PairKind::EdgeEdge, {first.a, first.b, second.a, second.b}, e, f});
    }
  }
}

template <class Bound, class BoundOfNode, class IsNear>
void ContactSurface::visit_pairs(const BoundOfNode& bound_of_node, const IsNear& is_near, const Visit& visit,
                                 const SearchOmissions& omitted) const {
  const auto of = feature_bounds<Bound>(bound_of_node, !omitted.edges);
  hierarchy_.for_each_pair(of.triangles, of.tree, is_near, [&](int s, int t) {
    if (!omitted.skips || !omitted.skips(s, t)) visit_features(s, t, of, is_near, visit);
  });
}

void ContactSurface::visit_near(const Points& x, double reach, const Visit& visit) const {
  const NearBoxes boxes(x, reach, around_);
  visit_pairs<NearBox>([&](int node) { return boxes.near(node, true); }, overlap, visit, {});
}

void ContactSurface::visit_near(const Points& x, double reach, const NodeMask& nodes, ThreadTeam& team,
                                const std::function<void(int share, const FeaturePair& pair)>& visit) const {
  const NearBoxes boxes(x, reach, around_);
  const auto box = [&](int node) { return boxes.near(node, nodes[static_cast<size_t>(node)] != 0); };
  const auto of = feature_bounds<NearBox>(box, true);
  std::vector<std::array<int, 2>> near;
  hierarchy_.for_each_pair(of.triangles, of.tree, overlap, [&near](int s, int t) { near.push_back({s, t}); });
  constexpr size_t kFewest = 256;  // pairs of triangles of a share, where there are several
  const size_t shares = std::min<size_t>(kShares, near.size() / kFewest + 1);
  team.run(static_cast<int>(shares), [&](int share, int) {
    const size_t first = near.size() * static_cast<size_t>(share) / shares,
                 last = near.size() * static_cast<size_t>(share + 1) / shares;
    for (size_t k = first; k < last; ++k)
      visit_features(near[k][0], near[k][1], of, overlap, [&](const FeaturePair& pair) {
        if (has_any(nodes, pair.nodes)) visit(share, pair);
      });
  });
}

void ContactSurface::visit_near(const Points& x, double reach, const MovingPart& moving,
                                const Visit& visit) const {
  const NearBoxes boxes(x, reach, around_);
  visit_pairs<NearBox>([&](int node) { return boxes.near(node, moving.moves(node)); }, overlap, visit, {});
}

void ContactSurface::visit_swept(const Points& x, const Points& d, double reach, const double& most,
                                 const Visit& visit, const SearchOmissions& omitted) const {
  const NearBoxes boxes(x, reach, around_);
  const double whole = most;  // as it is now
  visit_pairs<SweptBox>(
      [&](int node) {
        return boxes.swept(
            node, whole * d.col(node),
            omitted.all_but_around == nullptr || (*omitted.all_but_around)[static_cast<size_t>(node)] != 0);
      },
      [&](const SweptBox& a, const SweptBox& b) {
        return may_meet(a, b, whole > 0 ? static_cast<float>(most / whole) : 0);
      },
      visit, omitted);
}

}  // namespace coapt
