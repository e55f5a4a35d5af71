// A surface as seen from one side, on a square grid of nodes: how high it stands at each, which triangle is
// on top, and what of a polygon it leaves open. A valve seen from the atrium.
#pragma once

#include "core/types.hpp"

#include <vector>

namespace coapt {

// The viewer looks down along -up. Right-handed, orthonormal.
struct ViewFrame {
  Vec3 centre, e1, e2, up;
};

// Frame with the given direction up (any length) around a centre. Throws InputError when up is zero.
ViewFrame view_frame(const Vec3& centre, const Vec3& up);

// Coordinates along e1, e2 and up, 3 x count.
Points in_frame(const Points& points, const ViewFrame& frame);

// A stretch of a grid line, with the height of what ends it.
struct Strip {
  double begin = 0, end = 0;
  double begin_height = 0, end_height = 0;
};

// Node (i, j) lies at (x0 + i cell, y0 + j cell) and has number j columns + i. All lengths in the frame.
struct TopView {
  ViewFrame frame;
  double x0 = 0, y0 = 0, cell = 0;
  int columns = 0, rows = 0;
  std::vector<double> height;   // of the highest triangle; -infinity where there is none
  std::vector<int> triangle;    // that one; -1 where there is none
  std::vector<char> is_inside;  // the polygon, by the even-odd rule
  std::vector<char> is_open;    // inside the polygon and under no triangle
  // Along each row and each column: where lines are covered or outside the polygon, united exactly,
  // ascending.
  std::vector<std::vector<Strip>> blocked_rows, blocked_columns;

  int node_count() const { return columns * rows; }
  Vec3 position(double i, double j, double z) const;  // of a place on the grid, back in space
};

// The grid covers the closed polygon with at least `margin` cells around it; what of the surface lies beyond
// is not seen. Heights and strips are exact at the nodes and along the grid lines, whatever the cell; only
// what is narrower than a cell can escape. O(n + lengths of the triangles over the cell + nodes).
// Throws InputError for fewer than three corners, and for more than 2^14 lines. Pre: positions are finite,
// corner indices in range; cell > 0.
TopView top_view(const Points& points, const Triangles& triangles, const Points& polygon,
                 const ViewFrame& frame, double cell, int margin = 1);

}  // namespace coapt
