#include "image/segment/free_edge.hpp"

#include "core/error.hpp"
#include "image/segment/closed_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace coapt {
namespace {

constexpr double kInside = 0.5;                    // of the layer, to both sides [mm]
constexpr double kNearSide = 1.5, kFarSide = 2.5;  // of what lies beside it [mm]
constexpr double kEdgeReadingStep = 0.25;          // [mm]
constexpr double kLevelFrom = 2, kLevelTo = 6;     // from the annulus, where all leaflets are [mm]
constexpr double kShortest = 3;                    // leaflet [mm]
constexpr double kLeastContrast = -0.5, kGreatestContrast = 1.5;  // counted
constexpr double kSheetFactor = 1;      // of the evidence, above which contrast counts no more
constexpr int kClimb = 4;               // rows from one column to the next
constexpr double kClimbCost = 0.08;     // of a row, in contrasts times rows
constexpr double kEdgeSmoothing = 1.2;  // along the ring [mm]

double mean_between(const Volume& volume, const Vec3& x, const Vec3& normal, double from, double to) {
  double sum = 0;
  int count = 0;
  for (double t = from; t <= to + 1e-9; t += kEdgeReadingStep, ++count)
    sum += sample(volume, x + t * normal, kNaN);
  return sum / count;
}

// In values of the volume; NaN where a side lies outside of it.
Eigen::MatrixXd contrasts(const Volume& volume, const LayerGrid& grid) {
  Eigen::MatrixXd contrast(grid.rows, grid.columns);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const Vec3 x = grid.at(column, row), normal = grid.normals.col(grid.node(column, row));
      const double inside = mean_between(volume, x, normal, -kInside, kInside);
      const double outer = mean_between(volume, x, normal, kNearSide, kFarSide);
      const double inner = mean_between(volume, x, normal, -kFarSide, -kNearSide);
      contrast(row, column) = inside - std::min(outer, inner);
    }
  return contrast;
}

// Of the evidence of a sheet along the layer.
Eigen::MatrixXd strengths(const SheetEvidence& evidence, const LayerGrid& grid) {
  Eigen::MatrixXd strength(grid.rows, grid.columns);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      strength(row, column) =
          sheet_strength(evidence, grid.at(column, row), grid.normals.col(grid.node(column, row)));
  return strength;
}

double level_of(const Eigen::MatrixXd& contrast, const Eigen::MatrixXd& lengths) {
  std::vector<double> level;
  for (Eigen::Index column = 0; column < contrast.cols(); ++column)
    for (Eigen::Index row = 0; row < contrast.rows(); ++row)
      if (lengths(row, column) >= kLevelFrom && lengths(row, column) <= kLevelTo &&
          std::isfinite(contrast(row, column)))
        level.push_back(contrast(row, column));
  if (level.empty())
    throw InputError("the leaflets lie outside of the volume; is the annulus in its frame (LPS)?");
  const auto middle = level.begin() + static_cast<std::ptrdiff_t>(level.size() / 2);
  std::nth_element(level.begin(), middle, level.end());
  if (*middle <= 0)
    throw InputError(
        "no layer that is brighter than its sides hangs from the annulus; does the annulus lie in the "
        "volume's "
        "frame (LPS), and are the leaflets bright in it?");
  return *middle;
}

// State k: the leaflet ends between the rows k - 1 and k.
Eigen::MatrixXd end_costs(const Eigen::MatrixXd& contrast, const Eigen::MatrixXd& lengths) {
  Eigen::MatrixXd costs(contrast.rows() + 1, contrast.cols());
  for (Eigen::Index column = 0; column < contrast.cols(); ++column) {
    double sum = 0;
    costs(0, column) = 0;
    for (Eigen::Index row = 0; row < contrast.rows(); ++row) {
      const double value = std::isfinite(contrast(row, column)) ? contrast(row, column) : 0.0;
      sum +=
          lengths(row, column) < kShortest ? 1 : std::clamp(value, kLeastContrast, kGreatestContrast) - 0.5;
      costs(row + 1, column) = -sum;
    }
  }
  return costs;
}

// The mean of the neighbours, weighted by a Gaussian of the distance along the ring at the edge.
Vector smoothed(const Vector& lengths, const LayerGrid& grid, const std::vector<int>& path) {
  const int n = grid.columns;
  Vector smooth(n);
  const auto place = [&](int column) {
    return grid.at(column, std::clamp(path[static_cast<size_t>((column + n) % n)] - 1, 0, grid.rows - 1));
  };
  for (int column = 0; column < n; ++column) {
    const int row = std::clamp(path[static_cast<size_t>(column)] - 1, 0, grid.rows - 1);
    double sum = 0, weights = 0;
    for (int other = column - n / 8; other <= column + n / 8; ++other) {
      const double distance = (grid.at(other, row) - place(column)).norm();
      const double weight = std::exp(-0.5 * distance * distance / (kEdgeSmoothing * kEdgeSmoothing));
      sum += weight * lengths[(other + n) % n];
      weights += weight;
    }
    smooth[column] = sum / weights;
  }
  return smooth;
}

// How far beyond the edge the contrast is half: where the Gaussian integral has the share of the signal [mm].
double overshoot(double blur, double contrast, const GreyScale& scale) {
  if (!scale.is_logarithmic()) return 0;
  const double weakest = std::pow(10, -0.1 * scale.decibels_per_value * contrast);
  const double share = (std::sqrt(weakest) - weakest) / (1 - weakest);
  double low = 0, high = 6;  // of standard deviations; halved until it is found
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(middle / std::numbers::sqrt2) > share ? low : high) = middle;
  }
  return blur * low;
}

}  // namespace

FreeEdge free_edge(const Volume& volume, const SheetEvidence& evidence, const LayerGrid& grid, double blur,
                   const GreyScale& scale) {
  FreeEdge edge;
  const Eigen::MatrixXd lengths = lengths_along_columns(grid);
  Eigen::MatrixXd contrast = contrasts(volume, grid);
  edge.contrast = level_of(contrast, lengths);
  contrast = (contrast / edge.contrast).cwiseMin(kSheetFactor * strengths(evidence, grid));
  const std::vector<int> path = closed_path(end_costs(contrast, lengths), kClimb, kClimbCost);
  Vector found(grid.columns);
  for (int column = 0; column < grid.columns; ++column) {
    const int end = std::clamp(path[static_cast<size_t>(column)], 1, grid.rows - 1);
    found[column] = 0.5 * (lengths(end - 1, column) + lengths(end, column));
  }
  edge.lengths = smoothed(found, grid, path);
  edge.deviation = std::sqrt((found - edge.lengths).squaredNorm() / grid.columns);
  const double beyond = overshoot(blur, edge.contrast, scale);
  for (int column = 0; column < grid.columns; ++column)
    edge.lengths[column] =
        std::clamp(edge.lengths[column] - beyond, 0.5 * kShortest, lengths(grid.rows - 1, column));
  return edge;
}

}  // namespace coapt
