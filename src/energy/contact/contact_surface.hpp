// The features that may meet: vertices, edges and triangles of the membrane and of its obstacles, and the
// search for pairs of them.
#pragma once

#include "core/thread_team.hpp"
#include "energy/contact/pair_barrier.hpp"
#include "energy/moving_part.hpp"
#include "mesh/distance/box_hierarchy.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <vector>

namespace coapt {

// Two features that share no vertex; nodes as the columns of PairCorners. `first`, `second`: vertex and
// triangle, or the two edges.
struct FeaturePair {
  PairKind kind;
  std::array<int, 4> nodes;
  int first, second;
};

// By node, not zero where it is one of some.
using NodeMask = std::vector<char>;

inline bool has_any(const NodeMask& mask, const std::array<int, 4>& nodes) {
  return std::any_of(nodes.begin(), nodes.end(), [&](int node) { return mask[static_cast<size_t>(node)]; });
}

// What a search leaves out. skips: pairs of triangles whose features are not looked at; empty: none.
// all_but_around: all pairs of triangles but those with one of these nodes; null: none.
struct SearchOmissions {
  bool edges = false;
  std::function<bool(int s, int t)> skips = {};
  const NodeMask* all_but_around = nullptr;
};

class ContactSurface {
 public:
  // triangles: those of the membrane, then, from column `membrane_count` on, those of the obstacles, which do
  // not meet each other. excluded: pairs of triangles that may pass through each other; a pair of features is
  // left out when all its triangles are.
  ContactSurface(const Points& rest, Triangles triangles, int membrane_count,
                 std::vector<std::array<int, 2>> excluded);

  const Points& rest() const { return rest_; }
  const Triangles& triangles() const { return triangles_; }

  // The smaller of the rest areas that belong to the two features: a third of the triangles around
  // [length^2].
  double area(const FeaturePair& pair) const;

  using Visit = std::function<void(const FeaturePair&)>;

  static constexpr int kShares = 64;  // of a search, at most, which threads take

  // The pairs with one of the nodes that are nearer than `reach` at x, and some that are not (see NearBox),
  // each once, in shares, 0 <= share < kShares. Threads call visit side by side, those of one share one after
  // the other: it may write what belongs to that share alone.
  void visit_near(const Points& x, double reach, const NodeMask& nodes, ThreadTeam& team,
                  const std::function<void(int share, const FeaturePair& pair)>& visit) const;

  void visit_near(const Points& x, double reach, const Visit& visit) const;

  // The same, but only pairs of which some node is in a triangle with one that moves.
  void visit_near(const Points& x, double reach, const MovingPart& moving, const Visit& visit) const;

  // Pairs whose boxes come within `reach` of each other while x moves to x + s d, 0 <= s <= most. `most` may
  // fall during the visit.
  void visit_swept(const Points& x, const Points& d, double reach, const double& most, const Visit& visit,
                   const SearchOmissions& omitted = {}) const;

 private:
  struct SurfaceEdge {
    int a, b;
    double area;
    std::vector<int> triangles;
  };

  // Bounds of all features.
  template <class Bound>
  struct FeatureBounds {
    std::vector<Bound> nodes, edges, triangles, tree;
  };

  template <class Bound, class BoundOfNode>
  FeatureBounds<Bound> feature_bounds(const BoundOfNode& bound_of_node, bool with_edges) const;
  template <class Bound, class IsNear, class AnyVisit>
  void visit_features(int s, int t, const FeatureBounds<Bound>& of, const IsNear& is_near,
                      const AnyVisit& visit) const;
  template <class Bound, class BoundOfNode, class IsNear>
  void visit_pairs(const BoundOfNode& bound_of_node, const IsNear& is_near, const Visit& visit,
                   const SearchOmissions& omitted) const;
  bool is_excluded(const std::vector<int>& around_first, const std::vector<int>& around_second) const;

  Points rest_;
  Triangles triangles_;
  std::vector<std::array<int, 2>> excluded_;  // ascending, the smaller number first
  std::vector<SurfaceEdge> edges_;
  std::vector<double> vertex_area_;                         // per node
  std::vector<std::vector<int>> around_;                    // triangles around each node
  std::vector<std::vector<int>> own_vertices_, own_edges_;  // of each triangle: every feature has one owner
  BoxHierarchy hierarchy_;
};

}  // namespace coapt
