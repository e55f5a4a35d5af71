#include "image/segment/centre_layer.hpp"

#include "image/segment/trim_crossings.hpp"
#include "image/segment/wall_profile.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr int kCentreRounds = 2;  // of measuring and fitting
constexpr double kTaper = 3;      // from the ends, over which the layer moves less and less [mm]
constexpr double kMiddleReach = 2.6, kMiddlePatch = 1.2;  // of the profiles that are looked at [mm]
constexpr double kPeakReach = 1;                          // from the layer, where the sheet is strongest [mm]
constexpr double kSideShare = 0.25;                       // of the signal, at which a sheet has its sides

// From the strongest sample to where the values fall below the threshold, in samples; NaN where none does.
double side(const Eigen::Ref<const Vector>& values, Eigen::Index from, Eigen::Index step, double threshold) {
  for (Eigen::Index at = from + step; at >= 0 && at < values.size(); at += step)
    if (values[at] < threshold) {
      const double before = values[at - step];
      return static_cast<double>(at - step) +
             static_cast<double>(step) * (before - threshold) / (before - values[at]);
    }
  return kNaN;
}

}  // namespace

Vector sheet_middles(const Volume& volume, const LayerGrid& grid, const GreyScale& scale) {
  const WallProfiles profiles = wall_profiles(volume, grid, kMiddleReach, kMiddlePatch, 0);
  const auto half = (profiles.values.rows() - 1) / 2;
  const auto near = static_cast<Eigen::Index>(std::lround(kPeakReach / profiles.step));
  Vector middles = Vector::Constant(grid.points.cols(), kNaN);
  for (Eigen::Index node = 0; node < middles.size(); ++node) {
    const auto values = profiles.values.col(node);
    if (!values.allFinite()) continue;
    Eigen::Index peak = 0;
    const double strongest = values.segment(half - near, 2 * near + 1).maxCoeff(&peak);
    const double weakest = values.minCoeff();
    if (!(strongest > weakest)) continue;
    peak += half - near;
    const double threshold = value_at_share(scale, weakest, strongest, kSideShare);
    const double low = side(values, peak, -1, threshold), high = side(values, peak, 1, threshold);
    middles[node] = profiles.step * (0.5 * (low + high) - static_cast<double>(half));
  }
  return middles;
}

LayerFit centre_layer(LayerGrid& grid, const LayerFit& by_ridge, const Vector& ends, const Points& annulus,
                      const SheetEvidence& ridge, const Volume& volume, const GreyScale& scale,
                      double smoothing) {
  const Points before = grid.points;
  const Vector left = length_left(grid, ends);
  const PlacesAcross middles_above_ends = [&](const LayerGrid& here) {
    Vector places = sheet_middles(volume, here, scale);
    for (Eigen::Index node = 0; node < places.size(); ++node)
      if (left[node] <= 0 || std::isnan(places[node]))
        places[node] = (by_ridge.measured.col(node) - here.points.col(node)).dot(here.normals.col(node));
    return places;
  };
  const LayerFit fit = fit_layer(grid, annulus, ridge, smoothing, kCentreRounds, middles_above_ends);
  const Vector share = (left / kTaper).cwiseMax(0).cwiseMin(1);
  grid.points = before + (grid.points - before) * share.asDiagonal();
  update_normals(grid);
  return fit;
}

Vector lengths_at_same_places(const Vector& lengths, const LayerGrid& before, const LayerGrid& now) {
  const Eigen::MatrixXd from = lengths_along_columns(before), to = lengths_along_columns(now);
  Vector after(lengths.size());
  for (Eigen::Index column = 0; column < lengths.size(); ++column) {
    Eigen::Index row = 1;
    while (row + 1 < from.rows() && from(row, column) < lengths[column]) ++row;
    const double step = std::max(from(row, column) - from(row - 1, column), 1e-9);
    const double part = std::clamp((lengths[column] - from(row - 1, column)) / step, 0.0, 1.0);
    after[column] = (1 - part) * to(row - 1, column) + part * to(row, column);
  }
  return after;
}

}  // namespace coapt
