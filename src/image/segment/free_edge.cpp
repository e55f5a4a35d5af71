#include "image/segment/free_edge.hpp"

#include "core/error.hpp"
#include "image/edge/edge_network.hpp"
#include "image/segment/closed_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace coapt {
namespace {

constexpr double kInside = 0.5;                    // of the layer, to both sides [mm]
constexpr double kNearSide = 1.5, kFarSide = 2.5;  // of what lies beside it [mm]
constexpr double kEdgeReadingStep = 0.25;          // [mm]
constexpr double kLevelFrom = 2, kLevelTo = 6;     // from the annulus, where all leaflets are [mm]
constexpr double kShortest = 3;                    // leaflet [mm]
constexpr double kContrastShare = 1.0 / 3;         // of the contrast in the evidence where chords follow
constexpr double kContrastShareInBlood = 0.5;      // and where blood follows
constexpr double kLeafletInBlood = 0.64;           // as kLeaflet, where blood follows
constexpr double kBloodBelow = 0.02,
                 kChordsAbove = 0.08;         // strength beyond the edge, over that of the leaflets
constexpr double kFanFrom = 2.5, kFanTo = 5;  // from the edge, where that is read [mm]
constexpr double kLeaflet = 0.73;      // evidence over that of the leaflets, from which there is leaflet
constexpr double kChords = 0.53;       // what fans of chords have
constexpr double kEchoGap = 0.2;       // what gaps in the echoes have, and blood
constexpr double kGreatestGain = 0.3;  // of evidence above that of leaflets, counted
constexpr double kChordLoss = 0.25, kGapLoss = 0.02;  // what chords and gaps speak against a leaflet
constexpr double kStateStep = 0.5;                    // of the places where a column can end [mm]
constexpr int kBeside = 2;           // columns to each side that evidence at the edge is the mean of
constexpr double kEndInBlood = 0.5;  // evidence at an end that blood follows
constexpr double kBeyondFrom = 2.5, kBeyondTo = 4;  // from the edge, where chords are looked for [mm]
constexpr double kFarthestMove = 1.5;               // of the edge into blood [mm]
constexpr double kEdgeSmoothing = 1.2;              // along the ring [mm]
constexpr double kLogitCost = 0.2;                  // of a place that the network takes for the other

double mean_between(const Volume& volume, const Vec3& x, const Vec3& normal, double from, double to) {
  double sum = 0;
  int count = 0;
  for (double t = from; t <= to + 1e-9; t += kEdgeReadingStep, ++count)
    sum += sample(volume, x + t * normal, kNaN);
  return sum / count;
}

// To the darker side, in values of the volume; NaN where a side lies outside of it.
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

// The median where all leaflets are; NaN where nothing is known there.
double level_of(const Eigen::MatrixXd& values, const Eigen::MatrixXd& lengths) {
  std::vector<double> level;
  for (Eigen::Index column = 0; column < values.cols(); ++column)
    for (Eigen::Index row = 0; row < values.rows(); ++row)
      if (lengths(row, column) >= kLevelFrom && lengths(row, column) <= kLevelTo &&
          std::isfinite(values(row, column)))
        level.push_back(values(row, column));
  if (level.empty()) return kNaN;
  const auto middle = level.begin() + static_cast<std::ptrdiff_t>(level.size() / 2);
  std::nth_element(level.begin(), middle, level.end());
  return *middle;
}

// 1 where leaflets are, on the median; 0 where nothing is known.
Eigen::MatrixXd over_level(const Eigen::MatrixXd& values, const Eigen::MatrixXd& lengths) {
  const double level = level_of(values, lengths);
  const double unit = level > 0 ? level : 1;
  return values.unaryExpr([unit](double value) { return std::isfinite(value) ? value / unit : 0; });
}

// Of the sheet and of the contrast with the darker side, by the share of the latter.
Eigen::MatrixXd leaflet_evidence(const Eigen::MatrixXd& strength, const Eigen::MatrixXd& contrast,
                                 double share) {
  return (1 - share) * strength + share * contrast;
}

// What a millimetre speaks for leaflet. Least of all where chords fan out: a gap may be one of the echoes.
double gain_of(double evidence) {
  if (evidence >= kLeaflet) return std::min(evidence - kLeaflet, kGreatestGain);
  if (evidence >= kChords) return -kChordLoss * (kLeaflet - evidence) / (kLeaflet - kChords);
  const double share = std::clamp((evidence - kEchoGap) / (kChords - kEchoGap), 0.0, 1.0);
  return -(kGapLoss + (kChordLoss - kGapLoss) * share);
}

// State k: the leaflet ends k steps from the annulus.
Eigen::MatrixXd end_costs(const Eigen::MatrixXd& evidence, const Eigen::MatrixXd& lengths) {
  const Eigen::Index rows = evidence.rows();
  const double longest = lengths.row(rows - 1).maxCoeff();
  Eigen::MatrixXd costs(static_cast<Eigen::Index>(longest / kStateStep) + 2, evidence.cols());
  for (Eigen::Index column = 0; column < evidence.cols(); ++column) {
    const auto at = [&](Eigen::Index row) { return lengths(std::min(row, rows - 1), column); };
    costs(0, column) = 0;
    Eigen::Index row = 0;
    for (Eigen::Index state = 1; state < costs.rows(); ++state) {
      const double middle = (static_cast<double>(state) - 0.5) * kStateStep;
      while (row + 1 < rows && 0.5 * (at(row) + at(row + 1)) < middle) ++row;
      const double gain = middle < kShortest ? 1 : middle > at(rows) ? -1 : gain_of(evidence(row, column));
      costs(state, column) = costs(state - 1, column) - kStateStep * gain;
    }
  }
  return costs;
}

// The mean of the neighbours, weighted by a Gaussian of the distance along the ring at the edge.
Vector smoothed(const Vector& lengths, const LayerGrid& grid, const Eigen::MatrixXd& along) {
  const int n = grid.columns;
  Vector smooth(n);
  const auto row_of = [&](int column) {
    int row = 0;
    while (row + 1 < grid.rows && along(row + 1, column) < lengths[column]) ++row;
    return row;
  };
  for (int column = 0; column < n; ++column) {
    const int row = row_of(column);
    double sum = 0, weights = 0;
    for (int other = column - n / 8; other <= column + n / 8; ++other) {
      const double distance = (grid.at(other, row) - grid.at(column, row)).norm();
      const double weight = std::exp(-0.5 * distance * distance / (kEdgeSmoothing * kEdgeSmoothing));
      sum += weight * lengths[(other + n) % n];
      weights += weight;
    }
    smooth[column] = sum / weights;
  }
  return smooth;
}

// At a length along a column [mm], the mean with this number of columns to each side.
double value_at(const Eigen::MatrixXd& evidence, const Eigen::MatrixXd& lengths, int column, double length,
                int beside) {
  const auto columns = static_cast<int>(lengths.cols());
  double sum = 0;
  for (int other = column - beside; other <= column + beside; ++other) {
    const int c = (other + columns) % columns;
    Eigen::Index row = 0;
    while (row + 1 < lengths.rows() && lengths(row, c) < length) ++row;
    sum += evidence(row, c);
  }
  return sum / (2 * beside + 1);
}

// Where blood and no chords follow, an end that blurs fades sooner: there the edge lies where the evidence
// has fallen further.
Vector moved_to_blood(const Vector& ends, const Eigen::MatrixXd& evidence, const Eigen::MatrixXd& lengths) {
  Vector moved = ends;
  for (int column = 0; column < static_cast<int>(ends.size()); ++column) {
    double beyond = 0;
    for (double t = kBeyondFrom; t <= kBeyondTo; t += kStateStep)
      beyond = std::max(beyond, value_at(evidence, lengths, column, ends[column] + t, kBeside));
    const double blood = std::clamp(1 - beyond / kChords, 0.0, 1.0);
    const double least = kLeaflet - (kLeaflet - kEndInBlood) * blood;
    for (double t = 0; t <= kFarthestMove * blood; t += kEdgeReadingStep) {
      if (value_at(evidence, lengths, column, ends[column] + t, kBeside) < least) break;
      moved[column] = ends[column] + t;
    }
  }
  return moved;
}

// 1: blood follows everywhere, 0: chords do, by the mean strength beyond the ends.
double share_of_blood(const Vector& ends, const Eigen::MatrixXd& strength, const Eigen::MatrixXd& lengths) {
  double sum = 0;
  int count = 0;
  for (int column = 0; column < static_cast<int>(ends.size()); ++column)
    for (double t = kFanFrom; t <= kFanTo; t += kStateStep, ++count)
      sum += std::min(value_at(strength, lengths, column, ends[column] + t, 0), 1.0);
  return std::clamp((kChordsAbove - sum / count) / (kChordsAbove - kBloodBelow), 0.0, 1.0);
}

// Along each column, before it is smoothed [mm]. Where blood follows the strength of the sheet fades some two
// millimetres before the edge and the contrast does not: once a first edge says so it is found again.
Vector found_ends(const Eigen::MatrixXd& strength, const Eigen::MatrixXd& contrast,
                  const Eigen::MatrixXd& lengths) {
  Eigen::MatrixXd shown = leaflet_evidence(strength, contrast, kContrastShare);
  Vector ends = kStateStep * closed_polygon(end_costs(shown, lengths), {});
  const double blood = share_of_blood(ends, strength, lengths);
  if (blood > 0) {
    shown = leaflet_evidence(strength, contrast,
                             kContrastShare + blood * (kContrastShareInBlood - kContrastShare))
                .array() +
            blood * (kLeaflet - kLeafletInBlood);
    ends = kStateStep * closed_polygon(end_costs(shown, lengths), {});
  }
  return moved_to_blood(ends, shown, lengths);
}

// Lengths that leaflets can have, within the layer [mm].
Vector within(const Vector& ends, const Eigen::MatrixXd& lengths) {
  return ends.cwiseMax(0.5 * kShortest).cwiseMin(lengths.bottomRows(1).transpose());
}

// Along each column, by the network [mm].
Vector learnt_ends(const Volume& volume, const SheetEvidence& evidence, const LayerGrid& grid) {
  Eigen::MatrixXd logits = leaflet_logits(layer_channels(volume, evidence, grid), grid.columns);
  const auto certain = std::min(static_cast<Eigen::Index>(kShortest / kPlaceStep), logits.rows());
  logits.topRows(certain).setConstant(logits.maxCoeff());
  Eigen::MatrixXd costs = Eigen::MatrixXd::Zero(logits.rows() + 1, logits.cols());
  for (Eigen::Index place = 0; place < logits.rows(); ++place)
    costs.row(place + 1) = costs.row(place) - kLogitCost * logits.row(place);
  return kPlaceStep * closed_polygon(costs, {});
}

}  // namespace

FreeEdge free_edge(const Volume& volume, const SheetEvidence& evidence, const LayerGrid& grid,
                   EdgeRule rule) {
  FreeEdge edge;
  const Eigen::MatrixXd lengths = lengths_along_columns(grid);
  const Eigen::MatrixXd contrast = contrasts(volume, grid);
  edge.contrast = level_of(contrast, lengths);
  if (std::isnan(edge.contrast))
    throw InputError("the leaflets lie outside of the volume; is the annulus in its frame (LPS)?");
  if (edge.contrast <= 0)
    throw InputError(
        "no layer that is brighter than its sides hangs from the annulus; does the annulus lie in the "
        "volume's frame (LPS), and are the leaflets bright in it?");
  const Eigen::MatrixXd strength = over_level(strengths(evidence, grid), lengths);
  Vector found = found_ends(strength, over_level(contrast, lengths), lengths);
  edge.lengths = smoothed(found, grid, lengths);
  if (rule == EdgeRule::Learnt) {
    edge.clear = within(edge.lengths, lengths);
    found = learnt_ends(volume, evidence, grid);
    edge.lengths = smoothed(found, grid, lengths);
  }
  edge.deviation = std::sqrt((found - edge.lengths).squaredNorm() / grid.columns);
  edge.lengths = within(edge.lengths, lengths);
  return edge;
}

}  // namespace coapt
