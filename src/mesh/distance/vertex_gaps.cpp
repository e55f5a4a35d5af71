#include "mesh/distance/vertex_gaps.hpp"

#include "mesh/distance/triangle_distance.hpp"
#include "mesh/distance/triangle_tree.hpp"
#include "mesh/vertex_graph.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kBall =
    1.5;  // radius over the distance that is looked at: a flat sheet is its own neighbourhood

class GapFinder {
 public:
  GapFinder(const Points& x, const Triangles& triangles)
      : x_(x),
        triangles_(triangles),
        graph_(vertex_graph(triangles, x.cols())),
        tree_(x, triangles),
        mark_(static_cast<size_t>(x.cols()), 0) {}

  // The box grows until what it found is certainly the nearest.
  double gap(int v, double reach) {
    for (double size = reach / 8; size <= reach; size *= 2) {
      mark_neighbourhood(v, kBall * size);
      const double nearest = nearest_unmarked(v, size);
      if (nearest <= size) return nearest;
    }
    return kNaN;
  }

 private:
  bool mark(int v) {
    int& mark = mark_[static_cast<size_t>(v)];
    if (mark == stamp_) return false;
    mark = stamp_;
    return true;
  }

  bool is_marked(int v) const { return mark_[static_cast<size_t>(v)] == stamp_; }

  // Two rings, then all that hangs together with v within the ball.
  void mark_neighbourhood(int v, double radius) {
    ++stamp_;
    mark(v);
    open_ = {v};
    for (size_t k = 0; k < open_.size(); ++k)
      for (const int next : graph_.of(open_[k])) {
        const bool is_near = (x_.col(next) - x_.col(v)).squaredNorm() <= radius * radius;
        if (is_near && mark(next)) open_.push_back(next);
      }
    for (const int ring1 : graph_.of(v)) {
      mark(ring1);
      for (const int ring2 : graph_.of(ring1)) mark(ring2);
    }
  }

  double nearest_unmarked(int v, double size) const {
    const Vec3 p = x_.col(v);
    double nearest = kInfinity;
    for (const int t : tree_.overlapping(bounds_around(p, size))) {
      const Eigen::Vector3i c = triangles_.col(t);
      if (is_marked(c[0]) || is_marked(c[1]) || is_marked(c[2])) continue;
      nearest = std::min(nearest, point_triangle_distance(p, x_.col(c[0]), x_.col(c[1]), x_.col(c[2])));
    }
    return nearest;
  }

  const Points& x_;
  const Triangles& triangles_;
  VertexGraph graph_;
  TriangleTree tree_;
  std::vector<int> mark_;  // == stamp_: in the neighbourhood of the present vertex
  int stamp_ = 0;
  std::vector<int> open_;
};

}  // namespace

Vector vertex_gaps(const Points& x, const Triangles& triangles, double reach) {
  Vector gaps = Vector::Constant(x.cols(), kNaN);
  if (triangles.cols() == 0 || !x.allFinite()) return gaps;
  GapFinder finder(x, triangles);
  for (int v = 0; v < x.cols(); ++v) gaps[v] = finder.gap(v, reach);
  return gaps;
}

}  // namespace coapt
