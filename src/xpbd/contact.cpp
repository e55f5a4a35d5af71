#include "xpbd/contact.hpp"

#include "mesh/triangle_mesh.hpp"
#include "xpbd/contact_features.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kCorrection = 0.125;  // h: that sweeps may add to the predicted move

// The lesser is the longest move of a step: neighbours on a flat sheet stay out of the search.
constexpr double kLongestOverThickness = 6;  // thicknesses: the longest predicted move
constexpr double kLongestOverEdge = 0.2;     // mean edge lengths: likewise

// Of vertices alone, which lets no node of the paper's valves be held back: in thicknesses.
constexpr double kLongestOfVertices = 2;

// Of v + s change, 0 <= s <= 1.
double least_length(const Vec3& v, const Vec3& change) {
  const double squared = change.squaredNorm();
  const double s = squared > 0 ? std::clamp(-v.dot(change) / squared, 0.0, 1.0) : 0;
  return (v + s * change).norm();
}

}  // namespace

ConstraintValue<4> ContactConstraint::at(const Points& x) const {
  const PairCorners c = pair_corners(x, nodes);
  const ClosestPair closest = closest_points(kind, c);
  const Vec3 difference = c * closest.weights;
  const double d = difference.norm(), sign = difference.dot(side) < 0 ? -1 : 1;
  const Vec3 normal = d > 0 ? Vec3(sign / d * difference) : side;
  ConstraintValue<4> v;
  v.value = sign * d - thickness;
  for (int a = 0; a < 4; ++a) v.gradient[static_cast<size_t>(a)] = closest.weights[a] * normal;
  return v;
}

XpbdContact::XpbdContact(const XpbdBody& body, const ContactOptions& options)
    : surface_(contact_surface(body)),
      neighbours_(static_cast<size_t>(body.rest.cols())),
      options_(options),
      longest_(options.features == XpbdContactFeatures::Vertices
                   ? kLongestOfVertices * options.thickness
                   : std::min(kLongestOverThickness * options.thickness,
                              kLongestOverEdge * mean_edge_length(body.rest, body.triangles))) {
  const auto join = [&](int a, int b) {
    neighbours_[static_cast<size_t>(a)].push_back(b);
    neighbours_[static_cast<size_t>(b)].push_back(a);
  };
  for (const Edge& edge : edges(surface_.triangles())) join(edge.a, edge.b);
  for (const auto& [a, b] : options.held_together) join(a, b);
  for (std::vector<int>& own : neighbours_) std::sort(own.begin(), own.end());
  find_joined_triangles();
}

// Whether no features of the two meet: every node of each is, or is joined to, one of every edge of the
// other, which is two of its three nodes.
bool XpbdContact::are_joined(int s, int t) const {
  const auto reaches = [&](int node, int other) {
    const std::vector<int>& near = neighbours_[static_cast<size_t>(node)];
    return node == other || std::binary_search(near.begin(), near.end(), other);
  };
  const auto& triangles = surface_.triangles();
  const bool has_edges = options_.features == XpbdContactFeatures::VerticesAndEdges;
  int apart[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) apart[i][j] = reaches(triangles(i, s), triangles(j, t)) ? 0 : 1;
  for (int i = 0; i < 3; ++i) {
    if (apart[i][0] && apart[i][1] && apart[i][2]) return false;  // a node and the other triangle
    if (apart[0][i] && apart[1][i] && apart[2][i]) return false;
  }
  for (int i = 0; has_edges && i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int k = (i + 1) % 3, l = (j + 1) % 3;
      if (apart[i][j] && apart[i][l] && apart[k][j] && apart[k][l]) return false;
    }
  return true;
}

void XpbdContact::find_joined_triangles() {
  const auto& triangles = surface_.triangles();
  std::vector<std::vector<int>> around(neighbours_.size());
  for (int t = 0; t < triangles.cols(); ++t)
    for (const int node : triangles.col(t)) around[static_cast<size_t>(node)].push_back(t);
  joined_.resize(static_cast<size_t>(triangles.cols()));
  for (int s = 0; s < triangles.cols(); ++s) {
    std::vector<int>& own = joined_[static_cast<size_t>(s)];
    for (const int node : triangles.col(s))
      for (const int next : neighbours_[static_cast<size_t>(node)])
        for (const int t : around[static_cast<size_t>(next)])
          if (t > s) own.push_back(t);
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
    std::erase_if(own, [&](int t) { return !are_joined(s, t); });
  }
}

bool XpbdContact::is_joined(const FeaturePair& pair) const {
  const int in_first = pair.kind == PairKind::PointTriangle ? 1 : 2;
  for (int i = 0; i < in_first; ++i) {
    const std::vector<int>& near = neighbours_[static_cast<size_t>(pair.nodes[static_cast<size_t>(i)])];
    for (int j = in_first; j < 4; ++j)
      if (std::binary_search(near.begin(), near.end(), pair.nodes[static_cast<size_t>(j)])) return true;
  }
  return false;
}

void XpbdContact::begin_step(const Points& x, const Points& predicted) {
  const double margin = 2 * kCorrection * options_.thickness, all_of_it = 1;
  std::vector<ContactConstraint> active;
  const auto add = [&](const FeaturePair& pair) {
    if (is_joined(pair)) return;
    const PairCorners c = pair_corners(x, pair.nodes);
    const ClosestPair closest = closest_points(pair.kind, c);
    // What moves along together, or past each other, does not come nearer.
    const Vec3 apart_now = c * closest.weights,
               change = pair_corners(predicted, pair.nodes) * closest.weights - apart_now;
    const double near = least_length(apart_now, change) - margin;
    if (near > options_.thickness) return;
    const double apart = closest_points(pair.kind, pair_corners(surface_.rest(), pair.nodes)).distance;
    const double thickness = std::min(options_.thickness, 0.5 * apart);
    if (near > thickness || !(thickness > 0)) return;
    ContactConstraint contact;
    contact.kind = pair.kind;
    contact.nodes = pair.nodes;
    contact.thickness = thickness;
    contact.alpha = options_.alpha;
    contact.stiffness = options_.stiffness;
    if (closest.distance > 0) contact.side = c * closest.weights / closest.distance;
    active.push_back(contact);
  };
  // Most of what is near is of one sheet, and joined: it is cleared triangle by triangle.
  const auto skips = [&](int s, int t) {
    const std::vector<int>& own = joined_[static_cast<size_t>(std::min(s, t))];
    return std::binary_search(own.begin(), own.end(), std::max(s, t));
  };
  surface_.visit_swept(x, predicted - x, options_.thickness + margin, all_of_it, add,
                       {options_.features == XpbdContactFeatures::Vertices, skips});
  active_ = ColouredConstraints<ContactConstraint>(active, static_cast<int>(x.cols()));
}

}  // namespace coapt
