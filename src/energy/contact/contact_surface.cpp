#include "energy/contact/contact_surface.hpp"

#include "mesh/distance/near_boxes.hpp"
#include "mesh/triangle_mesh.hpp"

#include <algorithm>

namespace coapt {

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
