#include "mesh/outlines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace coapt {
namespace {

// A step from a node to the next one along a row (even) or a column (odd).
using GridEdge = long;

struct CellEdge {
  GridEdge edge = 0;
  bool from_open = false, to_open = false;  // counter-clockwise around the cell
};

std::array<CellEdge, 4> cell_edges(const TopView& view, int i, int j) {
  const long n = view.columns, corner = j * n + i;
  const auto open = [&](long node) { return view.is_open[static_cast<size_t>(node)] != 0; };
  const bool a = open(corner), b = open(corner + 1), c = open(corner + n + 1), d = open(corner + n);
  return {
      {{2 * corner, a, b}, {2 * (corner + 1) + 1, b, c}, {2 * (corner + n), c, d}, {2 * corner + 1, d, a}}};
}

// The blocked strip on which a place lies; the nearest one where rounding puts it beside.
const Strip& strip_at(const std::vector<Strip>& strips, double x) {
  auto next = std::upper_bound(strips.begin(), strips.end(), x,
                               [](double place, const Strip& strip) { return place < strip.begin; });
  if (next == strips.begin()) return strips.front();
  const auto before = next - 1;
  if (next == strips.end() || x <= before->end || x - before->end <= next->begin - x) return *before;
  return *next;
}

// Where the rim crosses a step between an open and a blocked node, in the frame.
Vec3 crossing(const TopView& view, GridEdge edge) {
  const long node = edge / 2;
  const bool along_row = edge % 2 == 0;
  const int i = static_cast<int>(node % view.columns), j = static_cast<int>(node / view.columns);
  const double origin = along_row ? view.x0 : view.y0;
  const int step = along_row ? i : j;
  const double from = origin + step * view.cell, to = origin + (step + 1) * view.cell;
  const auto& strips =
      along_row ? view.blocked_rows[static_cast<size_t>(j)] : view.blocked_columns[static_cast<size_t>(i)];
  const bool opens_first = view.is_open[static_cast<size_t>(node)] != 0;
  const Strip& strip = strip_at(strips, opens_first ? to : from);
  const double place = std::clamp(opens_first ? strip.begin : strip.end, from, to);
  const double height = opens_first ? strip.begin_height : strip.end_height;
  return along_row ? Vec3(place, view.y0 + j * view.cell, height)
                   : Vec3(view.x0 + i * view.cell, place, height);
}

int open_end(const TopView& view, GridEdge edge) {
  const long node = edge / 2, other = node + (edge % 2 == 0 ? 1 : view.columns);
  return static_cast<int>(view.is_open[static_cast<size_t>(node)] ? node : other);
}

Outline measured(const TopView& view, const Points& plan) {
  Outline outline;
  const ViewFrame& frame = view.frame;
  Eigen::Matrix3d axes;
  axes << frame.e1, frame.e2, frame.up;
  outline.corners = (axes * plan).colwise() + frame.centre;
  const Vec3 origin = plan.col(0);
  double weighted = 0;
  for (Eigen::Index k = 0; k < plan.cols(); ++k) {
    const Vec3 a = plan.col(k) - origin, b = plan.col((k + 1) % plan.cols()) - origin;
    outline.area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
    const double length = (b - a).norm();
    outline.perimeter += length;
    weighted += length * (0.5 * (a[2] + b[2]) + origin[2]);
  }
  outline.mean_height = outline.perimeter > 0 ? weighted / outline.perimeter : origin[2];
  return outline;
}

}  // namespace

std::vector<Outline> open_outlines(const TopView& view) {
  // Within each cell the outline enters where the way around the cell leaves an open corner, and goes to
  // where that way came to it: the open area is on its left.
  std::vector<GridEdge> entries;
  std::unordered_map<GridEdge, GridEdge> next;
  for (int j = 0; j + 1 < view.rows; ++j)
    for (int i = 0; i + 1 < view.columns; ++i) {
      const auto node = static_cast<size_t>(j * view.columns + i),
                 above = node + static_cast<size_t>(view.columns);
      const int open =
          view.is_open[node] + view.is_open[node + 1] + view.is_open[above] + view.is_open[above + 1];
      if (open == 0 || open == 4) continue;
      const std::array<CellEdge, 4> edges = cell_edges(view, i, j);
      for (size_t k = 0; k < 4; ++k) {
        if (!(edges[k].from_open && !edges[k].to_open)) continue;
        size_t back = k;
        do back = (back + 3) % 4;
        while (edges[back].from_open || !edges[back].to_open);
        entries.push_back(edges[k].edge);
        next[edges[k].edge] = edges[back].edge;
      }
    }
  std::vector<Outline> outlines;
  std::unordered_set<GridEdge> done;
  for (const GridEdge first : entries) {
    if (!done.insert(first).second) continue;
    std::vector<Vec3> corners = {crossing(view, first)};
    for (GridEdge edge = next.at(first); edge != first; edge = next.at(edge)) {
      done.insert(edge);
      corners.push_back(crossing(view, edge));
    }
    Points plan(3, static_cast<Eigen::Index>(corners.size()));
    for (size_t k = 0; k < corners.size(); ++k) plan.col(static_cast<Eigen::Index>(k)) = corners[k];
    outlines.push_back(measured(view, plan));
    outlines.back().open_node = open_end(view, first);
  }
  return outlines;
}

}  // namespace coapt
