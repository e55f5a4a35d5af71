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

XpbdContact::XpbdContact(const XpbdBody& body, double thickness, double alpha, double stiffness)
    : surface_(contact_surface(body)),
      neighbours_(static_cast<size_t>(body.rest.cols())),
      thickness_(thickness),
      alpha_(alpha),
      stiffness_(stiffness),
      longest_(std::min(kLongestOverThickness * thickness,
                        kLongestOverEdge * mean_edge_length(body.rest, body.triangles))) {
  for (const Edge& edge : edges(surface_.triangles())) {
    neighbours_[static_cast<size_t>(edge.a)].push_back(edge.b);
    neighbours_[static_cast<size_t>(edge.b)].push_back(edge.a);
  }
  for (std::vector<int>& own : neighbours_) std::sort(own.begin(), own.end());
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
  const double margin = 2 * kCorrection * thickness_, all_of_it = 1;
  std::vector<ContactConstraint> active;
  surface_.visit_swept(x, predicted - x, thickness_ + margin, all_of_it, [&](const FeaturePair& pair) {
    const PairCorners c = pair_corners(x, pair.nodes);
    const ClosestPair closest = closest_points(pair.kind, c);
    // What moves along together does not come nearer.
    const Vec3 approach = (pair_corners(predicted, pair.nodes) - c) * closest.weights;
    const double near = closest.distance - approach.norm() - margin;
    if (near > thickness_ || is_joined(pair)) return;
    const double apart = closest_points(pair.kind, pair_corners(surface_.rest(), pair.nodes)).distance;
    const double thickness = std::min(thickness_, 0.5 * apart);
    if (near > thickness || !(thickness > 0)) return;
    ContactConstraint contact;
    contact.kind = pair.kind;
    contact.nodes = pair.nodes;
    contact.thickness = thickness;
    contact.alpha = alpha_;
    contact.stiffness = stiffness_;
    if (closest.distance > 0) contact.side = c * closest.weights / closest.distance;
    active.push_back(contact);
  });
  active_ = ColouredConstraints<ContactConstraint>(active, static_cast<int>(x.cols()));
}

}  // namespace coapt
