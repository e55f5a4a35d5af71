#include "energy/contact/barrier_candidates.hpp"

#include "energy/pour_elements.hpp"
#include "mesh/distance/collision_detection.hpp"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <utility>

namespace coapt {
namespace {

constexpr double kDistanceRoundOff = 1e-13;  // of a distance, relative to the greatest coordinate
constexpr double kLookedAt = 1 - 1e-9;       // share of the way that pairs are left out by

// The place of a pair in the order of all: vertices with triangles, then edges, by their numbers.
using Rank = std::uint64_t;
constexpr Rank kAfterAll = ~Rank{0};

Rank rank(const FeaturePair& pair) {
  const Rank kind = pair.kind == PairKind::PointTriangle ? 0 : 1;
  return kind << 63 | static_cast<Rank>(pair.first) << 32 | static_cast<Rank>(pair.second);
}

template <int kFirst>
bool are_apart(const PairCorners& x, double range) {
  const auto a = x.leftCols<kFirst>().array();
  const auto b = x.rightCols<4 - kFirst>().array();
  const Eigen::Array3d gap = (b.rowwise().minCoeff() - a.rowwise().maxCoeff())
                                 .max(a.rowwise().minCoeff() - b.rowwise().maxCoeff())
                                 .max(0.0);
  return gap.matrix().squaredNorm() >= range * range;
}

}  // namespace

PairCorners pair_corners(const Points& x, const int* nodes) {
  PairCorners corners;
  for (int a = 0; a < 4; ++a) corners.col(a) = x.col(nodes[a]);
  return corners;
}

double pair_step(PairKind kind, const PairCorners& x, const PairCorners& d, double most, double kept) {
  return kind == PairKind::PointTriangle ? point_triangle_step(x, d, most, kept)
                                         : edge_edge_step(x, d, most, kept);
}

bool boxes_are_apart(PairKind kind, const PairCorners& x, double range) {
  return kind == PairKind::PointTriangle ? are_apart<1>(x, range) : are_apart<2>(x, range);
}

BarrierCandidates::BarrierCandidates(Points found_at) : found_at_(std::move(found_at)) {
  if (found_at_.size() > 0) round_off_ = kDistanceRoundOff * found_at_.cwiseAbs().maxCoeff();
}

void BarrierCandidates::add(const BarrierCandidate& found) {
  pairs_.push_back(found.pair);
  rest_.push_back(found.rest);
  distance_.push_back(kLookedAt * found.distance - round_off_);
  stencils_.nodes.insert(stencils_.nodes.end(), found.pair.nodes.begin(), found.pair.nodes.end());
}

bool BarrierCandidates::renew(const Points& x, const NodeMask& searched,
                              std::span<const std::vector<BarrierCandidate>> found) {
  struct Place {
    Rank rank;
    const BarrierCandidate* found;
  };
  std::vector<Place> in_order;
  for (const auto& share : found)
    for (const BarrierCandidate& one : share) in_order.push_back({rank(one.pair), &one});
  std::sort(in_order.begin(), in_order.end(), [](const Place& a, const Place& b) { return a.rank < b.rank; });
  BarrierCandidates both(x);
  size_t old = 0;
  const auto keep_until = [&](Rank end) {
    for (; old < size() && rank(pairs_[old]) < end; ++old) {
      if (has_any(searched, pairs_[old].nodes)) continue;
      both.add({pairs_[old], rest_[old], 0});
      both.distance_.back() = distance_[old];
    }
  };
  for (const Place& one : in_order) {
    keep_until(one.rank);
    both.add(*one.found);
  }
  keep_until(kAfterAll);
  std::swap(*this, both);
  return stencils_.nodes != both.stencils_.nodes;
}

void BarrierCandidates::renumber(MovingPart& moving) {
  stencils_.nodes.clear();
  for (FeaturePair& pair : pairs_)
    for (int& node : pair.nodes) stencils_.nodes.push_back(node = moving.number(node));
}

BarrierCandidates BarrierCandidates::near(const Points& x, double ahead) const {
  BarrierCandidates found(x);
  const Vector moved = displacements(x);
  for (size_t k = 0; k < size(); ++k) {
    const double reach = rest_[k].range + ahead;
    if (distance_[k] - approach(k, moved) >= reach) continue;
    const PairCorners corners = pair_corners(x, nodes(k));
    if (boxes_are_apart(rest_[k].kind, corners, reach)) continue;
    const double distance = pair_distance(rest_[k].kind, corners);
    if (distance < reach) found.add({pairs_[k], rest_[k], distance});
  }
  return found;
}

Vector BarrierCandidates::displacements(const Points& x) const {
  Vector moved = Vector::Zero(x.cols());
  moved.head(found_at_.cols()) = (x.leftCols(found_at_.cols()) - found_at_).colwise().norm().transpose();
  return moved;
}

bool BarrierCandidates::are_within(const Points& x, double most) const {
  return found_at_.size() != 0 && ((x - found_at_).colwise().squaredNorm().array() <= most * most).all();
}

NodeMask BarrierCandidates::beyond(const Points& x, double most) const {
  NodeMask far(static_cast<size_t>(x.cols()), 1);
  for (Eigen::Index node = 0; node < found_at_.cols(); ++node)
    far[static_cast<size_t>(node)] = !((x.col(node) - found_at_.col(node)).squaredNorm() <= most * most);
  return far;
}

double BarrierCandidates::approach(size_t k, const Vector& moved) const {
  const int* n = nodes(k);
  if (rest_[k].kind == PairKind::PointTriangle)
    return moved[n[0]] + std::max({moved[n[1]], moved[n[2]], moved[n[3]]});
  return std::max(moved[n[0]], moved[n[1]]) + std::max(moved[n[2]], moved[n[3]]);
}

double BarrierCandidates::evaluate(const Points& x, double pressure, Sink& sink, long& active) const {
  const bool wants_gradient = sink.wants_gradient(), wants_hessian = sink.wants_hessian();
  const Vector moved = displacements(x);
  std::atomic<long> within = 0;
  const double energy = pour_elements<Evaluated>(
      stencils_, sink,
      [&](size_t k, Evaluated& out) {
        out.is_active = false;
        if (distance_[k] - approach(k, moved) >= rest_[k].range) return 0.0;
        const PairCorners corners = pair_corners(x, nodes(k));
        if (boxes_are_apart(rest_[k].kind, corners, rest_[k].range)) return 0.0;
        const ClosestPair closest = closest_points(rest_[k].kind, corners);
        if (closest.distance >= rest_[k].range) return 0.0;
        out.is_active = true;
        const double own =
            pressure * evaluate_barrier(rest_[k], corners, closest, sink.projection(),
                                        wants_gradient ? &out.g : nullptr, wants_hessian ? &out.h : nullptr);
        if (wants_gradient) out.g *= pressure;
        if (wants_hessian) out.h *= pressure;
        return own;
      },
      [&](size_t k, const Evaluated& in, Sink& to) {
        if (!in.is_active) return;
        const int* n = nodes(k);
        if (to.has_node(n[0])) within.fetch_add(1, std::memory_order_relaxed);
        for (int a = 0; wants_gradient && a < 4; ++a) to.add_gradient(n[a], in.g.segment<3>(3 * a));
        for (int a = 0; wants_hessian && a < 4; ++a)
          for (int b = 0; b < 4; ++b)
            to.add_block(16 * static_cast<long>(k), 4, a, b, in.h.block<3, 3>(3 * a, 3 * b));
      });
  active = within;
  return energy;
}

double BarrierCandidates::step_limit(const Points& x, const Points& d, double most, double kept) const {
  const Vector moved = displacements(x), speed = d.colwise().norm().transpose();
  double limit = most;
  for (size_t k = 0; k < size(); ++k) {
    const double distance = distance_[k] - approach(k, moved);
    if (limit * approach(k, speed) < kLookedAt * (1 - kept) * distance) continue;
    limit = std::min(
        limit, pair_step(rest_[k].kind, pair_corners(x, nodes(k)), pair_corners(d, nodes(k)), limit, kept));
  }
  return limit;
}

}  // namespace coapt
