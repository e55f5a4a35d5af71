#include "mesh/seams.hpp"

#include "core/bounded_int.hpp"
#include "mesh/seam_graph.hpp"
#include "mesh/triangle_mesh.hpp"
#include "mesh/vertex_graph.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

namespace coapt {
namespace {

constexpr double kDetour = 2;  // path along the mesh over the straight distance, above which parts are far

// Whether two triangles are within a distance of each other along the edges of the mesh.
class MeshPaths {
 public:
  MeshPaths(const Points& x, const Triangles& triangles)
      : x_(x),
        triangles_(triangles),
        graph_(vertex_graph(triangles, x.cols())),
        way_(static_cast<size_t>(x.cols()), kInfinity) {}

  bool are_within(int from, int to, double limit) {
    bool reached = false;
    for (int k = 0; k < 3; ++k) approach(triangles_(k, from), 0);
    while (!open_.empty() && !reached) {
      const auto [way, vertex] = open_.top();
      open_.pop();
      reached = (triangles_.col(to).array() == vertex).any();
      if (way > way_[static_cast<size_t>(vertex)]) continue;
      for (const int next : graph_.of(vertex)) {
        const double further = way + (x_.col(next) - x_.col(vertex)).norm();
        if (further <= limit) approach(next, further);
      }
    }
    for (const int vertex : touched_) way_[static_cast<size_t>(vertex)] = kInfinity;
    touched_.clear();
    open_ = {};
    return reached;
  }

 private:
  void approach(int vertex, double way) {
    if (way >= way_[static_cast<size_t>(vertex)]) return;
    way_[static_cast<size_t>(vertex)] = way;
    touched_.push_back(vertex);
    open_.push({way, vertex});
  }

  using Entry = std::pair<double, int>;
  const Points& x_;
  const Triangles& triangles_;
  VertexGraph graph_;
  std::vector<double> way_;
  std::vector<int> touched_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

class SeamFinder {
 public:
  SeamFinder(const TopView& view, const ClosedView& closed, const Points& x, const Triangles& triangles,
             const std::vector<char>& is_wanted)
      : view_(view),
        closed_(closed),
        triangles_(triangles),
        is_wanted_(is_wanted),
        mean_edge_(mean_edge_length(x, triangles)),
        paths_(x, triangles) {}

  // Corner (i, j) of the grid lies at (i - 1/2, j - 1/2); numbers as those of the nodes.
  std::vector<SeamStep> steps() {
    std::vector<SeamStep> found;
    const int n = view_.columns;
    for (int j = 0; j < view_.rows; ++j)
      for (int i = 0; i < n; ++i) {
        const int node = j * n + i;
        if (i > 0 && is_seam(node - 1, node)) found.push_back({node, node + n, sides(node - 1, node)});
        if (j > 0 && is_seam(node - n, node)) found.push_back({node, node + 1, sides(node - n, node)});
      }
    return found;
  }

 private:
  int source(int node) const { return closed_.source[static_cast<size_t>(node)]; }
  int top(int node) const {
    const int n = source(node);
    return n < 0 ? -1 : view_.triangle[static_cast<size_t>(n)];
  }
  std::array<int, 2> sides(int a, int b) const { return {top(a), top(b)}; }

  Vec3 place(int node) const {
    const int n = source(node);
    const int column = n % view_.columns, row = n / view_.columns;
    return {column * view_.cell, row * view_.cell, view_.height[static_cast<size_t>(n)]};
  }

  bool is_seam(int a, int b) {
    if (!is_wanted_[static_cast<size_t>(a)]) return false;
    const int s = top(a), t = top(b);
    if (s == t || s < 0 || t < 0) return false;
    for (int k = 0; k < 3; ++k)
      if ((triangles_.col(s).array() == triangles_(k, t)).any()) return false;
    return !paths_.are_within(s, t, kDetour * (place(b) - place(a)).norm() + 2 * mean_edge_);
  }

  const TopView& view_;
  const ClosedView& closed_;
  const Triangles& triangles_;
  const std::vector<char>& is_wanted_;
  double mean_edge_;
  MeshPaths paths_;
};

// Of the covered nodes around a grid corner the lowest: there the parts meet, also where one hangs over.
double corner_height(const ClosedView& closed, const TopView& view, int i, int j) {
  double lowest = kInfinity;
  for (int l = std::max(j - 1, 0); l <= std::min(j, view.rows - 1); ++l)
    for (int k = std::max(i - 1, 0); k <= std::min(i, view.columns - 1); ++k) {
      const double height = closed.height[static_cast<size_t>(l * view.columns + k)];
      if (std::isfinite(height)) lowest = std::min(lowest, height);
    }
  return lowest;
}

// Each point becomes the mean of those within `reach` steps; towards an end fewer, the same on both sides.
Points smoothed(const Points& points, int reach, bool is_closed) {
  Points result = points;
  const Eigen::Index n = points.cols(), period = n - 1;
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::Index half =
        is_closed ? std::min<Eigen::Index>(reach, period / 4) : std::min<Eigen::Index>({reach, k, n - 1 - k});
    Vec3 sum = Vec3::Zero();
    for (Eigen::Index m = k - half; m <= k + half; ++m)
      sum += points.col(is_closed ? ((m % period) + period) % period : m);
    result.col(k) = sum / static_cast<double>(2 * half + 1);
  }
  return result;
}

}  // namespace

double length_of(const Seam& seam) {
  double length = 0;
  for (Eigen::Index k = 1; k < seam.points.cols(); ++k)
    length += (seam.points.col(k) - seam.points.col(k - 1)).norm();
  return length;
}

std::vector<Seam> seams(const TopView& view, const ClosedView& closed, const Points& x,
                        const Triangles& triangles, const SeamRules& rules) {
  const int shortest = bounded_int(std::ceil(rules.shortest / view.cell), 2, std::max(2, view.node_count()));
  const int reach = std::max(6, 2 * rules.radius);
  std::vector<Seam> found;
  for (const SeamChain& chain :
       linked_chains(SeamFinder(view, closed, x, triangles, rules.is_wanted).steps(), shortest)) {
    Seam seam;
    seam.triangles = chain.triangles;
    Points points(3, static_cast<Eigen::Index>(chain.corners.size()));
    for (size_t k = 0; k < chain.corners.size(); ++k) {
      const int i = chain.corners[k] % view.columns, j = chain.corners[k] / view.columns;
      points.col(static_cast<Eigen::Index>(k)) =
          view.position(i - 0.5, j - 0.5, corner_height(closed, view, i, j));
    }
    seam.points = smoothed(points, reach, chain.corners.front() == chain.corners.back());
    found.push_back(std::move(seam));
  }
  return found;
}

}  // namespace coapt
