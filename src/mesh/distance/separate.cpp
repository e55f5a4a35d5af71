#include "mesh/distance/separate.hpp"

#include "mesh/distance/intersections.hpp"
#include "mesh/triangle_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <numeric>
#include <optional>

namespace coapt {
namespace {

constexpr double kTie = 0.25;          // of the gap: ways out that differ by less are as long as each other
constexpr double kEnough = 0.5;        // of the gap: a pair that is so far apart is left alone
constexpr size_t kFewNeighbours = 32;  // pairs that vote on the way out
constexpr double kOvershoot = 1.01;    // so that rounding does not leave a pair just short of its gap

using Corners = Eigen::Matrix3d;
using Pair = std::array<int, 2>;

// The first triangle goes below `plane` along `axis`, the second above.
struct WayOut {
  Vec3 axis;
  double plane = 0;
};

struct Side {
  Corners corners;
  std::array<bool, 3> is_held{};
};

double overlap(const Vec3& axis, const Corners& below, const Corners& above) {
  return (below.transpose() * axis).maxCoeff() - (above.transpose() * axis).minCoeff();
}

// The way along one axis, its sign included; none where held corners are in it.
std::optional<WayOut> way_along(const Vec3& axis, const Side& below, const Side& above, double gap) {
  const Vec3 low = below.corners.transpose() * axis, high = above.corners.transpose() * axis;
  double at_least = -kInfinity, at_most = kInfinity;
  for (size_t k = 0; k < 3; ++k) {
    const auto corner = static_cast<Eigen::Index>(k);
    if (below.is_held[k]) at_least = std::max(at_least, low[corner] + 0.5 * gap);
    if (above.is_held[k]) at_most = std::min(at_most, high[corner] - 0.5 * gap);
  }
  if (at_least > at_most) return std::nullopt;
  return WayOut{axis, std::clamp(0.5 * (low.maxCoeff() + high.minCoeff()), at_least, at_most)};
}

std::vector<Vec3> separating_axes(const Corners& a, const Corners& b) {
  std::vector<Vec3> axes;
  const auto add = [&](const Vec3& axis, double size) {
    if (axis.norm() > 1e-9 * size) axes.push_back(axis.normalized());
  };
  const auto edge = [](const Corners& c, int k) { return Vec3(c.col((k + 1) % 3) - c.col(k)); };
  for (const Corners& c : {a, b}) add(edge(c, 0).cross(edge(c, 1)), edge(c, 0).squaredNorm());
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Vec3 e = edge(a, i), f = edge(b, j);
      add(e.cross(f), e.norm() * f.norm());
    }
  return axes;
}

// The smallest triangle of the connected part that each triangle belongs to.
std::vector<int> connected_part(const Triangles& triangles, Eigen::Index node_count) {
  std::vector<int> root(static_cast<size_t>(node_count));
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int node) {
    while (root[static_cast<size_t>(node)] != node) {
      int& parent = root[static_cast<size_t>(node)];
      parent = root[static_cast<size_t>(parent)];
      node = parent;
    }
    return node;
  };
  for (const auto& t : triangles.colwise())
    for (int k = 1; k < 3; ++k) root[static_cast<size_t>(find(t[k]))] = find(t[0]);
  std::vector<int> first(static_cast<size_t>(node_count), -1), part;
  for (int t = 0; t < triangles.cols(); ++t) {
    int& smallest = first[static_cast<size_t>(find(triangles(0, t)))];
    if (smallest < 0) smallest = t;
    part.push_back(smallest);
  }
  return part;
}

class Separator {
 public:
  Separator(const Points& x, const Triangles& triangles, const SeparationOptions& options)
      : x_(x),
        triangles_(triangles),
        options_(options),
        part_(connected_part(triangles, x.cols())),
        pairs_of_(static_cast<size_t>(triangles.cols())),
        around_(static_cast<size_t>(x.cols())) {
    for (int t = 0; t < triangles.cols(); ++t)
      for (int k = 0; k < 3; ++k) around_[static_cast<size_t>(triangles(k, t))].push_back(t);
  }

  // One push for each pair, one after the other. Returns whether any corner moved.
  bool push(const std::vector<Pair>& pairs) {
    for (std::vector<int>& partners : pairs_of_) partners.clear();
    for (const auto& [s, t] : pairs) {
      pairs_of_[static_cast<size_t>(s)].push_back(t);
      pairs_of_[static_cast<size_t>(t)].push_back(s);
    }
    bool has_moved = false;
    for (Pair pair : pairs) {
      if (part_[static_cast<size_t>(pair[1])] < part_[static_cast<size_t>(pair[0])])
        std::swap(pair[0], pair[1]);
      has_moved |= push_apart(pair);
    }
    return has_moved;
  }

  const Points& positions() const { return x_; }

 private:
  bool push_apart(const Pair& pair) {
    const auto way = best_way(pair);
    if (!way) return false;
    const double half = 0.5 * kOvershoot * options_.gap;
    bool has_moved = false;
    for (int k = 0; k < 3; ++k) {
      const int below = triangles_(k, pair[0]), above = triangles_(k, pair[1]);
      has_moved |= move(below, way->axis, std::min(0.0, way->plane - half - way->axis.dot(x_.col(below))));
      has_moved |= move(above, way->axis, std::max(0.0, way->plane + half - way->axis.dot(x_.col(above))));
    }
    return has_moved;
  }

  // The way on which the pair and those around it overlap least: alone, pairs along one cut would go to
  // different sides.
  std::optional<WayOut> best_way(const Pair& pair) const {
    const Side a = side(pair[0]), b = side(pair[1]);
    const std::vector<Vec3> axes = separating_axes(a.corners, b.corners);
    const auto is_apart = [&](const Vec3& axis) {
      return std::min(overlap(axis, a.corners, b.corners), overlap(-axis, a.corners, b.corners)) <
             -kEnough * options_.gap;
    };
    if (std::any_of(axes.begin(), axes.end(), is_apart)) return std::nullopt;  // by other pushes
    const std::vector<Pair> near = pairs_around(pair);
    const Vec3 upwards = area_vector(x_, triangles_.col(pair[0]));
    std::optional<WayOut> best;
    double least = kInfinity;
    for (const Vec3& axis : axes) {
      const Vec3 preferred = axis.dot(upwards) < 0 ? Vec3(-axis) : axis;
      for (const Vec3& signed_axis : {preferred, Vec3(-preferred)}) {
        const auto way = way_along(signed_axis, a, b, options_.gap);
        if (!way) continue;
        double mean = 0;
        for (const auto& [s, t] : near)
          mean +=
              std::max(0.0, overlap(signed_axis, corners(s), corners(t))) / static_cast<double>(near.size());
        if (mean >= least - kTie * options_.gap) continue;
        least = mean;
        best = way;
      }
    }
    return best;
  }

  // Pairs of a triangle that is or touches the first with one that is or touches the second; some where they
  // are many.
  std::vector<Pair> pairs_around(const Pair& pair) const {
    std::vector<Pair> near;
    const std::vector<int> firsts = triangles_around(pair[0]), seconds = triangles_around(pair[1]);
    for (const int s : firsts)
      for (const int t : pairs_of_[static_cast<size_t>(s)])
        if (std::binary_search(seconds.begin(), seconds.end(), t)) near.push_back({s, t});
    const size_t stride = near.size() / kFewNeighbours + 1;
    std::vector<Pair> voters;
    for (size_t k = 0; k < near.size(); k += stride) voters.push_back(near[k]);
    return voters;
  }
  std::vector<int> triangles_around(int triangle) const {
    std::vector<int> all;
    for (int k = 0; k < 3; ++k) {
      const std::vector<int>& more = around_[static_cast<size_t>(triangles_(k, triangle))];
      all.insert(all.end(), more.begin(), more.end());
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  Corners corners(int t) const { return x_(Eigen::all, triangles_.col(t)); }
  Side side(int t) const {
    Side side{corners(t), {}};
    for (int k = 0; k < 3; ++k) side.is_held[static_cast<size_t>(k)] = is_held(triangles_(k, t));
    return side;
  }
  bool is_held(int node) const {
    return !options_.is_held.empty() && options_.is_held[static_cast<size_t>(node)];
  }
  bool move(int node, const Vec3& axis, double by) {
    if (by == 0 || is_held(node)) return false;
    x_.col(node) += by * axis;
    return true;
  }

  Points x_;
  const Triangles& triangles_;
  const SeparationOptions& options_;
  std::vector<int> part_;
  std::vector<std::vector<int>> pairs_of_;  // partners of each triangle
  std::vector<std::vector<int>> around_;    // triangles around each node
};

}  // namespace

std::vector<std::array<int, 2>> pairs_to_separate(const Points& x, const Triangles& triangles,
                                                  int membrane_count,
                                                  const std::vector<std::array<int, 2>>& excluded) {
  std::vector<std::array<int, 2>> pairs = intersecting_pairs(x, triangles);
  std::erase_if(pairs, [&](const std::array<int, 2>& pair) {
    return pair[0] >= membrane_count || std::binary_search(excluded.begin(), excluded.end(), pair);
  });
  return pairs;
}

Separation separate(const Points& x, const Triangles& triangles, const SeparationOptions& options) {
  const auto pairs_at = [&](const Points& at) {
    return pairs_to_separate(at, triangles, options.membrane_count, options.excluded);
  };
  Separator separator(x, triangles, options);
  std::vector<std::array<int, 2>> pairs = pairs_at(x);
  Separation result;
  while (!pairs.empty() && result.passes < options.most_passes) {
    ++result.passes;
    if (!separator.push(pairs)) break;
    pairs = pairs_at(separator.positions());
  }
  result.pairs_left = std::move(pairs);
  result.x = separator.positions();
  result.largest_displacement = (result.x - x).colwise().norm().maxCoeff();
  return result;
}

}  // namespace coapt
