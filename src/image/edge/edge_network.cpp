#include "image/edge/edge_network.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace coapt {
namespace {

constexpr int kOffsets = 21, kOnLayer = 8, kInnerSide = 0, kOuterSide = 16;  // along the normal; of these
constexpr double kFirstOffset = -4, kOffsetStep = 0.5;                       // [mm]
constexpr int kFirstLevel = 4, kLastLevel = 11;      // places from which levels are read: 2 to 6 mm
constexpr double kApartUnit = 0.75;                  // [mm]
constexpr float kStrongest = 3, kGreatestLogit = 4;  // counted
constexpr int kInputs = kOffsets + 3, kHidden = 12;  // channels
constexpr std::array kSpreads = {0, 1, 2, 4, 8, 0};  // of the taps of each layer, in places; 0: one tap
constexpr float kWeights[] = {
#include "image/edge/edge_weights.inc"
};

// A point or a normal of a column at a length from the annulus [mm].
Vec3 on_column(const LayerGrid& grid, const Points& of_nodes, const Eigen::MatrixXd& lengths, int column,
               double length) {
  const int c = (column + grid.columns) % grid.columns;
  int row = 0;
  while (row + 2 < grid.rows && lengths(row + 1, c) < length) ++row;
  const double span = std::max(lengths(row + 1, c) - lengths(row, c), 1e-9);
  const double part = std::clamp((length - lengths(row, c)) / span, 0.0, 1.0);
  return (1 - part) * of_nodes.col(grid.node(c, row)) + part * of_nodes.col(grid.node(c, row + 1));
}

// The median of a channel near the annulus.
float level_near_annulus(const Eigen::MatrixXf& channels, int channel, int columns) {
  std::vector<float> level;
  for (int place = kFirstLevel * columns; place < (kLastLevel + 1) * columns; ++place)
    if (place < channels.cols() && std::isfinite(channels(channel, place)))
      level.push_back(channels(channel, place));
  if (level.empty()) return 0;
  const auto middle = level.begin() + static_cast<std::ptrdiff_t>(level.size() / 2);
  std::nth_element(level.begin(), middle, level.end());
  return *middle;
}

// Taps around the ring and down the columns, whose ends go on as they are.
Eigen::MatrixXf convolved(const Eigen::MatrixXf& in, int columns, int outputs, int spread,
                          const float*& weights) {
  Eigen::MatrixXf out = Eigen::MatrixXf::Zero(outputs, in.cols());
  const int places = static_cast<int>(in.cols()) / columns, reach = spread > 0 ? 1 : 0;
  for (int down = -reach; down <= reach; ++down)
    for (int around = -reach; around <= reach; ++around, weights += outputs * in.rows()) {
      const Eigen::Map<const Eigen::MatrixXf> tap(weights, outputs, in.rows());
      for (int place = 0; place < places; ++place)
        for (int column = 0; column < columns; ++column) {
          const int row = std::clamp(place + down * spread, 0, places - 1);
          const int beside = (column + around * spread + columns) % columns;
          out.col(place * columns + column) += tap * in.col(row * columns + beside);
        }
    }
  out.colwise() += Eigen::Map<const Eigen::VectorXf>(weights, outputs);
  weights += outputs;
  return out;
}

}  // namespace

Eigen::MatrixXf layer_channels(const Volume& volume, const SheetEvidence& evidence, const LayerGrid& grid) {
  const Eigen::MatrixXd lengths = lengths_along_columns(grid);
  const int n = grid.columns,
            places = static_cast<int>(lengths.row(grid.rows - 1).maxCoeff() / kPlaceStep) + 1;
  Eigen::MatrixXf channels(kInputs, places * n);
  for (int place = 0; place < places * n; ++place) {
    const int column = place % n;
    const double length = (place / n + 0.5) * kPlaceStep;
    const Vec3 x = on_column(grid, grid.points, lengths, column, length);
    const Vec3 normal = on_column(grid, grid.normals, lengths, column, length).normalized();
    const Vec3 across = on_column(grid, grid.points, lengths, column + 1, length) -
                        on_column(grid, grid.points, lengths, column - 1, length);
    for (int k = 0; k < kOffsets; ++k)
      channels(k, place) =
          static_cast<float>(sample(volume, x + (kFirstOffset + kOffsetStep * k) * normal, kNaN));
    channels(kOffsets, place) = static_cast<float>(sheet_strength(evidence, x, normal));
    channels(kOffsets + 1, place) = static_cast<float>(0.5 * across.norm() / kApartUnit);
    channels(kOffsets + 2, place) = length > lengths(grid.rows - 1, column) ? 0.0F : 1.0F;
  }
  const float blood =
      std::min(level_near_annulus(channels, kInnerSide, n), level_near_annulus(channels, kOuterSide, n));
  const float unit = std::max(level_near_annulus(channels, kOnLayer, n) - blood, 1e-3F);
  const float strong = std::max(level_near_annulus(channels, kOffsets, n), 1e-3F);
  channels.topRows(kOffsets) = channels.topRows(kOffsets).unaryExpr(
      [&](float value) { return std::isfinite(value) ? (value - blood) / unit : 0.0F; });
  channels.row(kOffsets) = (channels.row(kOffsets) / strong).cwiseMin(kStrongest);
  for (int place = 0; place < places * n; ++place)
    if (channels(kInputs - 1, place) <= 0) channels.col(place).setZero();
  return channels;
}

Eigen::MatrixXd leaflet_logits(const Eigen::MatrixXf& channels, int columns) {
  Eigen::MatrixXf features = channels;
  const float* weights = kWeights;
  for (size_t layer = 0; layer < kSpreads.size(); ++layer) {
    const bool is_last = layer + 1 == kSpreads.size();
    Eigen::MatrixXf next = convolved(features, columns, is_last ? 1 : kHidden, kSpreads[layer], weights);
    if (!is_last) next = next.cwiseMax(0.0F);
    if (kSpreads[layer] > 0) next += features;
    features = next;
  }
  for (Eigen::Index place = 0; place < features.cols(); ++place)
    features(0, place) = channels(kInputs - 1, place) <= 0
                             ? -kGreatestLogit
                             : kGreatestLogit * std::tanh(features(0, place) / kGreatestLogit);
  return features.reshaped(columns, features.cols() / columns).transpose().cast<double>();
}

}  // namespace coapt
