#include "mesh/top_view.hpp"

#include "core/bounded_int.hpp"
#include "core/error.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace coapt {
namespace {

constexpr int kMostLines = 1 << 14;  // of a view, each way: the number of its nodes is an int

struct Crossing {
  double x = 0, height = 0;
};

// Where the segment crosses the line; an end on the line counts for the segment above it only, so that a
// closed curve crosses an even number of times.
bool crosses(const Vec3& a, const Vec3& b, double y, Crossing& at) {
  if ((a[1] <= y) == (b[1] <= y)) return false;
  const double part = (y - a[1]) / (b[1] - a[1]);
  at = {a[0] + (b[0] - a[0]) * part, a[2] + (b[2] - a[2]) * part};
  return true;
}

// Lines y = origin + k spacing.
struct Lines {
  double origin = 0, spacing = 0;
  int count = 0;
};

// The first and the last of the places 0 .. count - 1 from `low` to `high`; the last below the first where
// there are none. What has run away lies beyond any int.
std::pair<int, int> places_between(double low, double high, int count) {
  return {bounded_int(std::ceil(low), 0, count), bounded_int(std::floor(high), -1, count - 1)};
}

// Calls visit(line, triangle, strip) for every line that crosses a triangle.
template <typename Visit>
void cross_triangles(const Points& plan, const Triangles& triangles, const Lines& lines, const Visit& visit) {
  for (int t = 0; t < triangles.cols(); ++t) {
    const Vec3 corner[3] = {plan.col(triangles(0, t)), plan.col(triangles(1, t)), plan.col(triangles(2, t))};
    const auto [low, high] = std::minmax({corner[0][1], corner[1][1], corner[2][1]});
    const auto [first, last] = places_between((low - lines.origin) / lines.spacing,
                                              (high - lines.origin) / lines.spacing, lines.count);
    for (int line = first; line <= last; ++line) {
      const double y = lines.origin + line * lines.spacing;
      Crossing ends[3];
      int found = 0;
      for (int k = 0; k < 3; ++k) found += crosses(corner[k], corner[(k + 1) % 3], y, ends[found]);
      if (found != 2) continue;
      if (ends[1].x < ends[0].x) std::swap(ends[0], ends[1]);
      visit(line, t, Strip{ends[0].x, ends[1].x, ends[0].height, ends[1].height});
    }
  }
}

// What of each line lies outside the polygon.
void add_outside(const Points& polygon, const Lines& lines, std::vector<std::vector<Strip>>& blocked) {
  std::vector<std::vector<Crossing>> crossings(blocked.size());
  for (Eigen::Index c = 0; c < polygon.cols(); ++c) {
    const Vec3 a = polygon.col(c), b = polygon.col((c + 1) % polygon.cols());
    const auto [first, last] =
        places_between((std::min(a[1], b[1]) - lines.origin) / lines.spacing,
                       (std::max(a[1], b[1]) - lines.origin) / lines.spacing, lines.count);
    for (int line = first; line <= last; ++line)
      if (Crossing at; crosses(a, b, lines.origin + line * lines.spacing, at))
        crossings[static_cast<size_t>(line)].push_back(at);
  }
  for (size_t line = 0; line < blocked.size(); ++line) {
    std::vector<Crossing>& ends = crossings[line];
    std::sort(ends.begin(), ends.end(), [](const Crossing& l, const Crossing& r) { return l.x < r.x; });
    Strip strip{-kInfinity, kInfinity, 0, 0};
    for (size_t i = 0; i < ends.size(); ++i) {
      if (i % 2 == 1) {
        strip = {ends[i].x, kInfinity, ends[i].height, 0};
        continue;
      }
      strip.end = ends[i].x;
      strip.end_height = ends[i].height;
      blocked[line].push_back(strip);
    }
    blocked[line].push_back(strip);  // an open end: crossings come in pairs
  }
}

void unite(std::vector<Strip>& strips, double tolerance) {
  std::sort(strips.begin(), strips.end(), [](const Strip& l, const Strip& r) { return l.begin < r.begin; });
  size_t count = 0;
  for (const Strip& strip : strips) {
    if (count == 0 || strip.begin > strips[count - 1].end + tolerance) {
      strips[count++] = strip;
    } else if (strip.end > strips[count - 1].end) {
      strips[count - 1].end = strip.end;
      strips[count - 1].end_height = strip.end_height;
    }
  }
  strips.resize(count);
}

Points turned(const Points& plan) {
  Points result = plan;
  result.row(0).swap(result.row(1));
  return result;
}

// The nodes of the rows that lie on none of their strips. Pre: the last strip of each row has no end.
std::vector<char> between(const TopView& view, const std::vector<std::vector<Strip>>& rows) {
  std::vector<char> free(static_cast<size_t>(view.node_count()), 0);
  for (int j = 0; j < view.rows; ++j) {
    auto strip = rows[static_cast<size_t>(j)].begin();
    for (int i = 0; i < view.columns; ++i) {
      const double x = view.x0 + i * view.cell;
      while (strip->end < x) ++strip;
      free[static_cast<size_t>(j * view.columns + i)] = x < strip->begin;
    }
  }
  return free;
}

void raise_nodes(TopView& view, int row, int triangle, const Strip& strip) {
  const auto [first, last] =
      places_between((strip.begin - view.x0) / view.cell, (strip.end - view.x0) / view.cell, view.columns);
  const double slope =
      strip.end > strip.begin ? (strip.end_height - strip.begin_height) / (strip.end - strip.begin) : 0;
  for (int i = first; i <= last; ++i) {
    const double height = strip.begin_height + slope * (view.x0 + i * view.cell - strip.begin);
    const auto node = static_cast<size_t>(row * view.columns + i);
    if (height <= view.height[node]) continue;
    view.height[node] = height;
    view.triangle[node] = triangle;
  }
}

}  // namespace

ViewFrame view_frame(const Vec3& centre, const Vec3& up) {
  if (!(up.norm() > 0)) throw InputError("the direction of a view is zero");
  ViewFrame frame;
  frame.centre = centre;
  frame.up = up.normalized();
  frame.e1 = frame.up.unitOrthogonal();
  frame.e2 = frame.up.cross(frame.e1);
  return frame;
}

Points in_frame(const Points& points, const ViewFrame& frame) {
  Eigen::Matrix3d axes;
  axes << frame.e1, frame.e2, frame.up;
  return axes.transpose() * (points.colwise() - frame.centre);
}

Vec3 TopView::position(double i, double j, double z) const {
  return frame.centre + (x0 + i * cell) * frame.e1 + (y0 + j * cell) * frame.e2 + z * frame.up;
}

TopView top_view(const Points& points, const Triangles& triangles, const Points& polygon,
                 const ViewFrame& frame, double cell, int margin) {
  if (polygon.cols() < 3) throw InputError("a polygon needs at least three corners");
  const Points plan = in_frame(points, frame), outline = in_frame(polygon, frame);
  const Vec3 low = outline.rowwise().minCoeff(), extent = outline.rowwise().maxCoeff() - low;
  TopView view;
  view.frame = frame;
  view.cell = cell;
  view.x0 = low[0] - (margin + 0.5) * cell;
  view.y0 = low[1] - (margin + 0.5) * cell;
  if (!(extent.head<2>().maxCoeff() / cell + 2.0 * margin < kMostLines))
    throw InputError("a view of more than " + std::to_string(kMostLines) + " lines; choose larger cells");
  view.columns = bounded_int(std::ceil(extent[0] / cell), 0, kMostLines) + 2 * margin + 2;
  view.rows = bounded_int(std::ceil(extent[1] / cell), 0, kMostLines) + 2 * margin + 2;
  view.height.assign(static_cast<size_t>(view.node_count()), -kInfinity);
  view.triangle.assign(static_cast<size_t>(view.node_count()), -1);
  view.blocked_rows.resize(static_cast<size_t>(view.rows));
  view.blocked_columns.resize(static_cast<size_t>(view.columns));

  const Lines rows{view.y0, cell, view.rows}, columns{view.x0, cell, view.columns};
  add_outside(outline, rows, view.blocked_rows);
  add_outside(turned(outline), columns, view.blocked_columns);
  view.is_inside = between(view, view.blocked_rows);
  cross_triangles(plan, triangles, rows, [&](int row, int triangle, const Strip& strip) {
    raise_nodes(view, row, triangle, strip);
    view.blocked_rows[static_cast<size_t>(row)].push_back(strip);
  });
  cross_triangles(turned(plan), triangles, columns, [&](int column, int, const Strip& strip) {
    view.blocked_columns[static_cast<size_t>(column)].push_back(strip);
  });
  const double tolerance = 1e-12 * extent.head<2>().maxCoeff();
  for (auto& strips : view.blocked_rows) unite(strips, tolerance);
  for (auto& strips : view.blocked_columns) unite(strips, tolerance);
  view.is_open = between(view, view.blocked_rows);
  return view;
}

}  // namespace coapt
