// Bounds of mesh features in single precision, by which a search for contact rules out most pairs.
#pragma once

#include "mesh/distance/box_hierarchy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace coapt {

using Four [[gnu::vector_size(16)]] = float;  // numbers that are compared at once

// Four intervals in single precision, in units of the scene's extent.
struct Intervals {
  static constexpr Four kFar = {1e30F, 1e30F, 1e30F, 1e30F};
  Four low = kFar, high = -kFar;  // empty

  void include(const Intervals& other) {
    low = other.low < low ? other.low : low;
    high = other.high > high ? other.high : high;
  }
};

inline bool intersect(const Intervals& a, const Intervals& b) {
  const auto each = (a.low <= b.high) & (b.low <= a.high);  // -1: yes
  std::uint64_t halves[2];
  std::memcpy(halves, &each, sizeof halves);
  return (halves[0] & halves[1]) == ~std::uint64_t{0};
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
inline bool overlap(const NearBox& a, const NearBox& b) {
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
inline bool may_meet(const SweptBox& a, const SweptBox& b, float share) {
  constexpr float kAmple = 1 + 1e-5F;  // on a time: beyond round-off
  constexpr Four kNever = {1e30F, 1e30F, 1e30F, 1e30F}, kZero = {};
  if (!(a.move.high[3] > 0) && !(b.move.high[3] > 0)) return false;
  if (intersect(a.at, b.at)) return true;  // as neighbours do
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
    constexpr float kRoot3 = 1.7320509F;  // of 3, rounded up: |(1, 1, 1) d| <= root |d|
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

}  // namespace coapt
