#include "image/segment/track_layer.hpp"

#include "core/closed_path.hpp"
#include "mesh/curve_match.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

namespace coapt {
namespace {

// Least radius over which leaflets bend [mm]: bundles of chords leave them more sharply. It gives half the
// range of the turns that are tried at each step; then their number, and what they cost in the unit of the
// evidence: a turn by the whole range, and a difference of one turn between neighbours.
constexpr double kLeastRadius = 5;
constexpr int kTurns = 13;
constexpr double kTurnCost = 0.15;
constexpr double kTurnDifference = 0.1;
// At the annulus: directions from 45 degrees on the side of the atrium to 120 degrees.
constexpr double kFirstDirection = -0.8, kLastDirection = 2.1;
constexpr int kDirections = 30;
// How far ahead the evidence is read, at the annulus and further on [mm].
constexpr double kFirstReach = 5, kAheadReach = 2.5;
constexpr double kAheadStep = 0.5;  // [mm]
// A row with less evidence than this, on average, has none.
constexpr double kNoEvidence = 0.08;
constexpr double kGap = 8;  // after which nothing more is expected [mm]
// Share of the way to equal distances by which points slide along their ring at each step.
constexpr double kSlide = 0.2;
constexpr double kStrongest = 1.5;  // evidence above it counts no more
constexpr int kCurvePoints = 8;     // of the smooth annulus between two that were given

// Directions of all columns in which the sheet may go on, and the tangents of the ring.
struct Front {
  Points points, directions, tangents;
};

Points tangents_of(const Points& ring) {
  const Eigen::Index n = ring.cols();
  Points tangents(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3 across = ring.col((i + 2) % n) - ring.col((i + n - 2) % n);
    tangents.col(i) = across.normalized();
  }
  return tangents;
}

double evidence_ahead(const SheetEvidence& evidence, const Vec3& from, const Vec3& direction,
                      const Vec3& tangent, double reach) {
  const Vec3 normal = direction.cross(tangent);
  double sum = 0;
  int count = 0;
  for (double t = kAheadStep; t <= reach; t += kAheadStep, ++count)
    sum += std::min(sheet_strength(evidence, from + t * direction, normal), kStrongest);
  return sum / count;
}

Vec3 middle_of(const Points& points) { return points.rowwise().mean(); }

// The directions at the annulus, by the angle from inwards to the ventricle.
Points first_directions(const SheetEvidence& evidence, const Points& ring, const Points& tangents,
                        const Vec3& ventricle) {
  const Eigen::Index n = ring.cols();
  const Vec3 middle = middle_of(ring);
  std::vector<Points> candidates(kDirections, Points(3, n));
  Eigen::MatrixXd costs(kDirections, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3 tangent = tangents.col(i);
    const Vec3 down = (ventricle - ventricle.dot(tangent) * tangent).normalized();
    Vec3 inward = down.cross(tangent).normalized();
    if (inward.dot(middle - ring.col(i)) < 0) inward = -inward;
    for (int d = 0; d < kDirections; ++d) {
      const double angle = kFirstDirection + (kLastDirection - kFirstDirection) * d / (kDirections - 1);
      const Vec3 direction = std::cos(angle) * inward + std::sin(angle) * down;
      candidates[static_cast<size_t>(d)].col(i) = direction;
      costs(d, i) = -evidence_ahead(evidence, ring.col(i), direction, tangent, kFirstReach);
    }
  }
  const std::vector<int> path = closed_path(costs, 2, kTurnDifference);
  Points directions(3, n);
  for (Eigen::Index i = 0; i < n; ++i)
    directions.col(i) = candidates[static_cast<size_t>(path[static_cast<size_t>(i)])].col(i);
  return directions;
}

// The directions at the next row: those of the last one, turned.
Points next_directions(const SheetEvidence& evidence, const Front& front, double step) {
  const Eigen::Index n = front.points.cols();
  Eigen::MatrixXd costs(kTurns, n);
  Points straight(3, n);
  const auto turned = [&](Eigen::Index i, int turn) -> Vec3 {
    const double angle = step / kLeastRadius * (2.0 * turn / (kTurns - 1) - 1);
    return Eigen::AngleAxisd(angle, front.tangents.col(i)) * straight.col(i);
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3 tangent = front.tangents.col(i), before = front.directions.col(i);
    straight.col(i) = (before - before.dot(tangent) * tangent).normalized();
    for (int turn = 0; turn < kTurns; ++turn) {
      const double part = 2.0 * turn / (kTurns - 1) - 1;
      costs(turn, i) = kTurnCost * part * part -
                       evidence_ahead(evidence, front.points.col(i), turned(i, turn), tangent, kAheadReach);
    }
  }
  const std::vector<int> path = closed_path(costs, 2, kTurnDifference);
  Points directions(3, n);
  for (Eigen::Index i = 0; i < n; ++i) directions.col(i) = turned(i, path[static_cast<size_t>(i)]);
  // The turns have steps: what they differ by between neighbours is evened out.
  Points smooth = directions;
  for (Eigen::Index i = 0; i < n; ++i)
    smooth.col(i) =
        (directions.col((i + n - 1) % n) + 2 * directions.col(i) + directions.col((i + 1) % n)).normalized();
  return smooth;
}

// The points slide along the ring towards equal distances, without going around it on the whole.
void even_out(Points& ring) {
  const Eigen::Index n = ring.cols();
  const Points before = ring;
  Vector at(n + 1);
  at[0] = 0;
  for (Eigen::Index i = 0; i < n; ++i) at[i + 1] = at[i] + (before.col((i + 1) % n) - before.col(i)).norm();
  const Vector equal = Vector::LinSpaced(n + 1, 0, at[n]).head(n);
  const double turn = (at.head(n) - equal).mean();
  for (Eigen::Index i = 0; i < n; ++i) {
    double place = at[i] + kSlide * (equal[i] + turn - at[i]);
    place -= at[n] * std::floor(place / at[n]);
    const auto next = std::upper_bound(at.begin() + 1, at.end() - 1, place) - at.begin();
    const double part = (place - at[next - 1]) / std::max(at[next] - at[next - 1], 1e-12);
    ring.col(i) = (1 - part) * before.col(next - 1) + part * before.col(next % n);
  }
}

double mean_evidence(const SheetEvidence& evidence, const Front& front) {
  double sum = 0;
  for (Eigen::Index i = 0; i < front.points.cols(); ++i) {
    const Vec3 direction = front.directions.col(i), tangent = front.tangents.col(i);
    sum += std::min(sheet_strength(evidence, front.points.col(i), direction.cross(tangent)), 1.0);
  }
  return sum / static_cast<double>(front.points.cols());
}

}  // namespace

Points annulus_ring(const Points& given, const Vec3& ventricle, double step) {
  const Points annulus = smooth_closed_curve(given, kCurvePoints);
  const Eigen::Index n = annulus.cols();
  Vector lengths(n + 1);
  lengths[0] = 0;
  Vec3 area = Vec3::Zero();
  const Vec3 middle = middle_of(annulus);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Vec3 here = annulus.col(i), next = annulus.col((i + 1) % n);
    lengths[i + 1] = lengths[i] + (next - here).norm();
    area += (here - middle).cross(next - middle);
  }
  const bool is_reversed = area.dot(ventricle) > 0;  // clockwise seen from the atrium
  const auto count = std::max<Eigen::Index>(24, std::lround(lengths[n] / step));
  Points ring(3, count);
  Eigen::Index edge = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double at = lengths[n] * static_cast<double>(i) / static_cast<double>(count);
    while (edge < n - 1 && lengths[edge + 1] < at) ++edge;
    const double part = (at - lengths[edge]) / std::max(lengths[edge + 1] - lengths[edge], 1e-12);
    ring.col(is_reversed ? (count - i) % count : i) =
        (1 - part) * annulus.col(edge) + part * annulus.col((edge + 1) % n);
  }
  return ring;
}

LayerGrid track_layer(const SheetEvidence& evidence, const Points& ring, const TrackOptions& options) {
  const int greatest_rows = static_cast<int>(options.greatest_length / options.step) + 1;
  std::vector<Points> rows{ring};
  Front front{ring, {}, tangents_of(ring)};
  front.directions = first_directions(evidence, ring, front.tangents, options.ventricle);
  double gap = 0;
  while (static_cast<int>(rows.size()) < greatest_rows && gap < kGap) {
    front.points += options.step * front.directions;
    even_out(front.points);
    front.tangents = tangents_of(front.points);
    rows.push_back(front.points);
    gap = mean_evidence(evidence, front) < kNoEvidence ? gap + options.step : 0;
    front.directions = next_directions(evidence, front, options.step);
  }
  LayerGrid grid;
  grid.columns = static_cast<int>(ring.cols());
  grid.rows = static_cast<int>(rows.size());
  grid.points.resize(3, ring.cols() * grid.rows);
  for (int row = 0; row < grid.rows; ++row)
    grid.points.middleCols(row * ring.cols(), ring.cols()) = rows[static_cast<size_t>(row)];
  update_normals(grid);
  return grid;
}

double evidence_on_side(const SheetEvidence& evidence, const Points& ring, const TrackOptions& options) {
  Front front{ring, {}, tangents_of(ring)};
  front.directions = first_directions(evidence, ring, front.tangents, options.ventricle);
  double sum = 0;
  for (Eigen::Index i = 0; i < ring.cols(); ++i)
    sum += evidence_ahead(evidence, ring.col(i), front.directions.col(i), front.tangents.col(i), kFirstReach);
  return sum / static_cast<double>(ring.cols());
}

}  // namespace coapt
