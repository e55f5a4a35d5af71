#include "image/segment/wall_profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

namespace coapt {
namespace {

constexpr double kLeastWidth = 0.1, kGreatestWidth = 4;  // [mm]
constexpr double kFirstWidth = 1;                        // [mm]
constexpr int kEvaluations = 60;                         // of one fit
constexpr double kGreatestCentre = 1.2;                  // [mm]

// The part of a sheet of this width that is seen at an offset from its middle.
double blurred_top_hat(double offset, double width, double blur) {
  const double scale = 1 / (blur * std::numbers::sqrt2);
  return 0.5 * (std::erf((offset + 0.5 * width) * scale) - std::erf((offset - 0.5 * width) * scale));
}

// Parameters: centre, logarithm of the width, weaker and stronger value (those of the signal itself, before
// it is blurred).
struct WallResiduals {
  using Scalar = double;
  using InputType = Vector;
  using ValueType = Vector;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  const WallProfiles& profiles;
  Eigen::Index point;
  double blur;
  const GreyScale& scale;

  double value_at(double offset, double width, const Vector& p) const {
    return value_at_share(scale, p[2], std::max(p[3], p[2]), blurred_top_hat(offset - p[0], width, blur));
  }

  int inputs() const { return 4; }
  int values() const { return static_cast<int>(profiles.values.rows()); }

  int operator()(const Vector& p, Vector& residuals) const {
    const double width = std::exp(std::clamp(p[1], std::log(kLeastWidth), std::log(kGreatestWidth)));
    for (Eigen::Index k = 0; k < profiles.values.rows(); ++k) {
      const double at = profiles.offset(k), aside = std::sqrt(3.0) * profiles.scatter;
      const double value =
          (4 * value_at(at, width, p) + value_at(at - aside, width, p) + value_at(at + aside, width, p)) / 6;
      residuals[k] = value - profiles.values(k, point);
    }
    return 0;
  }
};

}  // namespace

WallProfiles wall_profiles(const Volume& volume, const LayerGrid& grid, double reach, double radius,
                           double place_deviation) {
  WallProfiles profiles;
  // Linear interpolation takes part of its value from f (1 - f) squared voxels away, a sixth on average.
  profiles.scatter = std::sqrt(volume.spacing.squaredNorm() / 3 / 6 + place_deviation * place_deviation);
  const int half = static_cast<int>(std::lround(reach / profiles.step));
  const Eigen::Index samples = 2 * half + 1;
  Eigen::MatrixXd raw(samples, grid.points.cols());
  for (Eigen::Index node = 0; node < grid.points.cols(); ++node)
    for (Eigen::Index k = 0; k < samples; ++k)
      raw(k, node) = sample(
          volume,
          grid.points.col(node) + (static_cast<double>(k) - half) * profiles.step * grid.normals.col(node),
          kNaN);
  profiles.values.resize(samples, grid.points.cols());
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const double around = 0.5 * (grid.at(column + 1, row) - grid.at(column - 1, row)).norm();
      const int columns = std::min(static_cast<int>(radius / std::max(around, 1e-3)), grid.columns / 4);
      const int below = std::max(row, 1);
      const double along = (grid.at(column, below) - grid.at(column, below - 1)).norm();
      const int rows = std::min(static_cast<int>(radius / std::max(along, 1e-3)), grid.rows);
      Vector sum = Vector::Zero(samples), count = Vector::Zero(samples);
      for (int r = std::max(row - rows, 0); r <= std::min(row + rows, grid.rows - 1); ++r)
        for (int c = column - columns; c <= column + columns; ++c)
          for (Eigen::Index k = 0; k < samples; ++k)
            if (const double value = raw(k, grid.node(c, r)); std::isfinite(value)) {
              sum[k] += value;
              count[k] += 1;
            }
      profiles.values.col(grid.node(column, row)) = sum.cwiseQuotient(count);
    }
  return profiles;
}

WallFit fit_wall(const WallProfiles& profiles, Eigen::Index point, double blur, const GreyScale& scale) {
  WallFit fit;
  const auto values = profiles.values.col(point);
  if (!values.allFinite()) return fit;
  const double weaker = values.minCoeff(), stronger = values.maxCoeff();
  Eigen::Index brightest = 0;
  values.maxCoeff(&brightest);
  if (!(stronger > weaker)) return fit;
  const WallResiduals residuals{profiles, point, blur, scale};
  Eigen::NumericalDiff<WallResiduals> derivatives(residuals);
  Eigen::LevenbergMarquardt<Eigen::NumericalDiff<WallResiduals>> solver(derivatives);
  solver.parameters.maxfev = kEvaluations;
  Vector p(4);
  p << std::clamp(profiles.offset(brightest), -1.0, 1.0), std::log(kFirstWidth), weaker, stronger;
  solver.minimize(p);
  Vector left(values.size());
  residuals(p, left);
  fit.centre = p[0];
  fit.width = std::exp(p[1]);
  fit.residual = std::sqrt(left.squaredNorm() / static_cast<double>(left.size())) / (stronger - weaker);
  fit.is_found = p.allFinite() && p[3] > p[2] && std::abs(fit.centre) < kGreatestCentre &&
                 fit.width > kLeastWidth && fit.width < kGreatestWidth;
  return fit;
}

}  // namespace coapt
