#include "image/segment/trim_crossings.hpp"

#include "image/segment/unfold_rows.hpp"
#include "mesh/distance/intersections.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr int kRounds = 100;         // at most, in each of which every column is shortened once
constexpr double kClearance = 0.25;  // by which a column ends above what crosses [mm]
constexpr double kSteepest = 3;      // of the edge, length along a column over that along the row
constexpr double kMost = 6;          // that a column loses [mm]

// Distance of a column from the next one, in the row where a column of this length ends.
double step_at(const LayerGrid& grid, const Eigen::MatrixXd& lengths, int column, double end) {
  int row = 0;
  while (row + 1 < grid.rows && lengths(row + 1, column) <= end) ++row;
  return (grid.at(column + 1, row) - grid.at(column, row)).norm();
}

// Twice around, so that it does not matter where the first column is.
void limit_slope(const LayerGrid& grid, const Eigen::MatrixXd& lengths, Vector& ends) {
  const int n = grid.columns;
  for (int k = 0; k < 2 * n; ++k) {
    const int a = k % n, b = (k + 1) % n;
    ends[b] = std::min(ends[b], ends[a] + kSteepest * step_at(grid, lengths, a, ends[a]));
  }
  for (int k = 2 * n; k > 0; --k) {
    const int a = (k - 1) % n, b = k % n;
    ends[a] = std::min(ends[a], ends[b] + kSteepest * step_at(grid, lengths, a, ends[b]));
  }
}

// Where the columns have to end so that none of the triangles is left that cross and are nearer to the end.
Vector ends_without_crossing(const LayerGrid& grid, const Eigen::MatrixXd& lengths, const Vector& ends) {
  const Vector left = length_left(grid, ends);
  const TriangleMesh kept = kept_part(grid, left);
  Vector wanted = Vector::Constant(grid.columns, kInfinity);
  for (const auto& [s, t] : intersecting_pairs(kept.vertices, kept.triangles)) {
    const Eigen::Vector3i of_s = kept.triangles.col(s), of_t = kept.triangles.col(t);
    const Eigen::Vector3i& goes = left(of_s).sum() < left(of_t).sum() ? of_s : of_t;
    const int row = goes.minCoeff() / grid.columns;
    for (const int node : goes) {
      double& end = wanted[node % grid.columns];
      end = std::min(end, lengths(row, node % grid.columns) - kClearance);
    }
  }
  return wanted;
}

}  // namespace

Vector length_left(const LayerGrid& grid, const Vector& ends) {
  const Eigen::MatrixXd lengths = lengths_along_columns(grid);
  Vector left(grid.points.cols());
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      left[grid.node(column, row)] = ends[column] - lengths(row, column);
  return left;
}

bool lower_ends(const LayerGrid& grid, const Vector& given, const Vector& wanted, Vector& ends) {
  const Vector lowered = ends.cwiseMin(wanted.cwiseMax((given.array() - kMost).cwiseMax(0).matrix()));
  if (lowered == ends) return false;
  ends = lowered;
  limit_slope(grid, lengths_along_columns(grid), ends);
  return true;
}

Vector trim_crossings(const LayerGrid& grid, const Vector& given) {
  const Eigen::MatrixXd lengths = lengths_along_columns(grid);
  Vector ends = given;
  for (int round = 0; round < kRounds; ++round)
    if (!lower_ends(grid, given, ends_without_crossing(grid, lengths, ends), ends)) break;
  return ends;
}

}  // namespace coapt
