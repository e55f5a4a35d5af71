#include "image/segment/gap_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace coapt {
namespace {

constexpr double kShownEvidence = 0.3;  // from which a place counts as shown
constexpr double kCurvatureArm = 3;     // over which curvatures are taken, so that noise is none of them [mm]
constexpr size_t kLeastCurvatures = 20;  // below which their spread says nothing

std::vector<char> shown_places(const LayerGrid& grid, const Vector& evidence) {
  std::vector<char> is_shown(static_cast<size_t>(evidence.size()));
  for (Eigen::Index node = 0; node < evidence.size(); ++node)
    is_shown[static_cast<size_t>(node)] = node < grid.columns || evidence[node] >= kShownEvidence;
  return is_shown;
}

double variance_of(const std::vector<double>& values) {
  if (values.size() < kLeastCurvatures) return 0;
  double sum = 0, squares = 0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const auto count = static_cast<double>(values.size());
  return std::max(squares / count - sum * sum / (count * count), 0.0);
}

// Variance of the curvatures along the ring (or along the columns) where all three places are shown [1/mm^2].
double curvature_variance(const LayerGrid& grid, const std::vector<char>& is_shown, bool is_along_ring) {
  std::vector<double> curvatures;
  const auto is_seen = [&](int column, int row) {
    return is_shown[static_cast<size_t>(grid.node(column, row))] != 0;
  };
  for (int row = 0; row + 1 < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const Vec3 x = grid.at(column, row);
      const Vec3 next = is_along_ring ? grid.at(column + 1, row) : grid.at(column, row + 1);
      const int steps =
          std::max(1, static_cast<int>(std::lround(kCurvatureArm / std::max((next - x).norm(), 1e-3))));
      const int c = is_along_ring ? steps : 0, r = is_along_ring ? 0 : steps;
      if (2 * c >= grid.columns || row - r < 0 || row + r >= grid.rows) continue;
      if (!is_seen(column, row) || !is_seen(column + c, row + r) || !is_seen(column - c, row - r)) continue;
      const Vec3 ahead = grid.at(column + c, row + r) - x, behind = grid.at(column - c, row - r) - x;
      const double arms = ahead.norm() * behind.norm();
      if (arms > 0) curvatures.push_back(grid.normals.col(grid.node(column, row)).dot(ahead + behind) / arms);
    }
  return variance_of(curvatures);
}

}  // namespace

Vector gap_deviation(const LayerGrid& grid, const Vector& evidence) {
  const std::vector<char> is_shown = shown_places(grid, evidence);
  const double curvature =
      std::sqrt(0.5 * (curvature_variance(grid, is_shown, true) + curvature_variance(grid, is_shown, false)));
  Points shown(3, std::count(is_shown.begin(), is_shown.end(), char{1}));
  for (Eigen::Index node = 0, at = 0; node < grid.points.cols(); ++node)
    if (is_shown[static_cast<size_t>(node)]) shown.col(at++) = grid.points.col(node);
  Vector deviation = Vector::Zero(grid.points.cols());
  for (Eigen::Index node = 0; node < grid.points.cols(); ++node)
    if (!is_shown[static_cast<size_t>(node)])
      deviation[node] =
          0.5 * curvature * (shown.colwise() - grid.points.col(node)).colwise().squaredNorm().minCoeff();
  return deviation;
}

}  // namespace coapt
