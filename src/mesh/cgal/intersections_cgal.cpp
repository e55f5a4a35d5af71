#include "mesh/cgal/intersections_cgal.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <CGAL/intersections.h>
#include <algorithm>

namespace coapt {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

// A box that knows the number of its triangle.
class TriangleBox : public CGAL::Box_intersection_d::Box_d<double, 3> {
 public:
  TriangleBox(const CGAL::Bbox_3& box, int number)
      : CGAL::Box_intersection_d::Box_d<double, 3>(box), number_(number) {}
  int number() const { return number_; }

 private:
  int number_;
};

class Judge {
 public:
  Judge(const Points& points, const Triangles& triangles) : points_(points), triangles_(triangles) {}

  CGAL::Bbox_3 box(int t) const { return corner(t, 0).bbox() + corner(t, 1).bbox() + corner(t, 2).bbox(); }

  bool share_a_vertex(int s, int t) const {
    for (int k = 0; k < 3; ++k)
      if ((triangles_.col(s).array() == triangles_(k, t)).any()) return true;
    return false;
  }

  bool meet(int s, int t) const {
    const bool s_is_flat = is_flat(s), t_is_flat = is_flat(t);
    if (s_is_flat && t_is_flat) return false;
    if (s_is_flat) return flat_meets(s, triangle(t));
    if (t_is_flat) return flat_meets(t, triangle(s));
    return CGAL::do_intersect(triangle(s), triangle(t));
  }

 private:
  Point corner(int t, int k) const {
    const auto p = points_.col(triangles_(k, t));
    return {p[0], p[1], p[2]};
  }

  Kernel::Triangle_3 triangle(int t) const { return {corner(t, 0), corner(t, 1), corner(t, 2)}; }

  bool is_flat(int t) const { return CGAL::collinear(corner(t, 0), corner(t, 1), corner(t, 2)); }

  // Corners on one line: from the first to the last of them in the order of their coordinates.
  bool flat_meets(int t, const Kernel::Triangle_3& other) const {
    const auto [first, last] = std::minmax({corner(t, 0), corner(t, 1), corner(t, 2)});
    if (first == last) return other.has_on(first);
    return CGAL::do_intersect(Kernel::Segment_3(first, last), other);
  }

  const Points& points_;
  const Triangles& triangles_;
};

}  // namespace

std::vector<std::array<int, 2>> intersecting_pairs_cgal(const Points& points, const Triangles& triangles) {
  const Judge checker(points, triangles);
  std::vector<TriangleBox> boxes;
  boxes.reserve(static_cast<size_t>(triangles.cols()));
  for (int t = 0; t < triangles.cols(); ++t) boxes.emplace_back(checker.box(t), t);
  std::vector<std::array<int, 2>> pairs;
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const TriangleBox& a, const TriangleBox& b) {
    const int s = std::min(a.number(), b.number()), t = std::max(a.number(), b.number());
    if (!checker.share_a_vertex(s, t) && checker.meet(s, t)) pairs.push_back({s, t});
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace coapt
