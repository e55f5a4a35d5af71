// Which vertex may go into which of its neighbours, and what becomes of the mesh then.
#include "mesh/remesh/detail/coarsener.hpp"

#include <algorithm>

namespace coapt::coarsening {
namespace {

constexpr double kLeastQuality = 0.3;  // of a new triangle, or no worse than the worst before
constexpr double kRoundOff = 1e-8;     // within which costs count as equal
constexpr double kLineCosine = 0.6;    // between the two edges of a line at a vertex that may go

}  // namespace

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
  Collapse best{kInfinity, kInfinity, v, -1};
  for (const int u : star_.ring) {
    if (is_on_line(v) && !is_line(v, u)) continue;
    if (at(kinds_, v) != 0 && at(kinds_, u) != at(kinds_, v)) continue;
    const std::optional<double> cost = cost_of(v, u, (1 + kRoundOff) * best.cost);
    if (!cost) continue;
    const Collapse collapse{leading_digits(*cost), leading_digits((x_.col(u) - x_.col(v)).norm()), v, u};
    if (collapse.is_before(best)) best = collapse;
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
  std::sort(candidates.begin(), candidates.end(),
            [](const Collapse& l, const Collapse& r) { return l.is_before(r); });
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

}  // namespace coapt::coarsening
