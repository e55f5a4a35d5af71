// A closed line of few straight pieces through a cyclic sequence of columns.
#pragma once

#include <Eigen/Core>

namespace coapt {

struct ClosedPolygonOptions {
  int columns = 5;         // of a piece, about
  int greatest_rise = 14;  // of a piece, in states
  double bend_cost = 0.2;  // of a corner, for each state that the rise of one piece differs from the next
};

// For each column the state, interpolated between the corners, that together cost least: the sum of what the
// states cost (states x columns, linear between states) and of what the corners cost. By dynamic programming
// over the last two corners (Amini et al. 1990), twice around, so that it no longer depends on its start; the
// middle round is the answer. Unlike a path whose steps cost, a long slope costs nothing, and a gap of
// evidence is passed over along it. Pre: at least eight columns, two states.
Eigen::VectorXd closed_polygon(const Eigen::MatrixXd& costs, const ClosedPolygonOptions& options);

}  // namespace coapt
