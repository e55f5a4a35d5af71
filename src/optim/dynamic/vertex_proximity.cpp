#include "optim/dynamic/vertex_proximity.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kShareOfRest = 0.5;  // nearer than this share of the distance at rest counts as near

PairCorners gather(const Points& x, const std::array<int, 4>& nodes) {
  PairCorners corners;
  for (int a = 0; a < 4; ++a) corners.col(a) = x.col(nodes[static_cast<size_t>(a)]);
  return corners;
}

}  // namespace

VertexProximity::VertexProximity(const Points& rest, const Triangles& triangles, double distance)
    : surface_(rest, triangles, static_cast<int>(triangles.cols()), {}), distance_(distance) {}

int VertexProximity::find(const Points& x) {
  pairs_.clear();
  surface_.visit_near(x, distance_, [&](const FeaturePair& pair) {
    if (pair.kind != PairKind::PointTriangle) return;
    const PairCorners corners = gather(x, pair.nodes);
    const ClosestPair closest = closest_points(pair.kind, corners);
    if (!(closest.distance > 0 && closest.distance < distance_)) return;
    const double at_rest = closest_points(pair.kind, gather(surface_.rest(), pair.nodes)).distance;
    if (closest.distance >= kShareOfRest * at_rest) return;
    pairs_.push_back({pair.nodes, closest.weights, corners * closest.weights / closest.distance});
  });
  return static_cast<int>(pairs_.size());
}

void VertexProximity::stop_approach(Points& v, const Vector& mass) const {
  for (const Pair& pair : pairs_) {
    const double approach = -pair.normal.dot(gather(v, pair.nodes) * pair.weights);
    if (approach <= 0) continue;
    double compliance = 0;
    for (int a = 0; a < 4; ++a)
      compliance += pair.weights[a] * pair.weights[a] / mass[pair.nodes[static_cast<size_t>(a)]];
    if (compliance == 0) continue;
    for (int a = 0; a < 4; ++a) {
      const int node = pair.nodes[static_cast<size_t>(a)];
      v.col(node) += approach / compliance * pair.weights[a] / mass[node] * pair.normal;
    }
  }
}

Points VertexProximity::balancing_forces(const Points& force) const {
  Points balancing = Points::Zero(3, force.cols());
  for (const Pair& pair : pairs_) {
    const int vertex = pair.nodes[0];
    const double pressing = -pair.normal.dot(Vec3(force.col(vertex) + balancing.col(vertex)));
    if (pressing <= 0) continue;
    for (int a = 0; a < 4; ++a)
      balancing.col(pair.nodes[static_cast<size_t>(a)]) += pressing * pair.weights[a] * pair.normal;
  }
  return balancing;
}

}  // namespace coapt
