#include "image/segment/line_in_image.hpp"

#include "mesh/distance/surface_distance.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kLineStep = 0.5, kShortestLine = 3;  // along the line [mm]
constexpr double kPatchPixel = 0.4;                   // across it [mm]
constexpr int kPatchBeside = 12, kPatchAbove = 10;  // pixels that are compared, to each side, and up and down
constexpr int kMostShift = 10;                      // by which they are shifted at most
constexpr double kDrawnSheet = 0.7;     // standard deviation of a drawn sheet: the finest that is sought [mm]
constexpr double kAlongLine = 2;        // of the correlation along the line [mm]
constexpr int kTangentSteps = 4;        // steps to both sides, from which the line's direction is taken
constexpr int kAveragedSteps = 2;       // steps to both sides, over which the image is averaged
constexpr double kLeastLikeness = 0.7;  // correlation from which the image shows the line

// Of one place of the line.
struct Station {
  Vec3 place, along, beside;  // unit vectors; `beside` is orthogonal to `up`
};

Points at_equal_steps(const Points& piece) {
  std::vector<double> length = {0};
  for (Eigen::Index k = 1; k < piece.cols(); ++k)
    length.push_back(length.back() + (piece.col(k) - piece.col(k - 1)).norm());
  const auto count = static_cast<Eigen::Index>(length.back() / kLineStep) + 1;
  Points places(3, count);
  size_t k = 1;
  for (Eigen::Index n = 0; n < count; ++n) {
    const double at = kLineStep * static_cast<double>(n);
    while (k + 1 < length.size() && length[k] < at) ++k;
    const double stretch = length[k] - length[k - 1];
    const double share = stretch > 0 ? std::clamp((at - length[k - 1]) / stretch, 0.0, 1.0) : 0;
    const auto end = static_cast<Eigen::Index>(k);
    places.col(n) = piece.col(end - 1) + share * (piece.col(end) - piece.col(end - 1));
  }
  return places;
}

std::vector<Station> stations_on(const Points& places, const Vec3& up) {
  std::vector<Station> stations;
  for (Eigen::Index n = 0; n < places.cols(); ++n) {
    Vec3 along = places.col(std::min(n + kTangentSteps, places.cols() - 1)) -
                 places.col(std::max<Eigen::Index>(n - kTangentSteps, 0));
    along -= up.dot(along) * up;
    if (along.norm() > 0)
      along.normalize();
    else  // the line goes straight up
      along = stations.empty() ? Vec3(up.unitOrthogonal()) : stations.back().along;
    stations.push_back({places.col(n), along, along.cross(up)});
  }
  return stations;
}

// The plane across the line: columns from side to side, rows upwards, this many to each side of the place.
Points plane_points(const Station& station, const Vec3& up, int beside, int above) {
  Points points(3, (2 * beside + 1) * (2 * above + 1));
  Eigen::Index n = 0;
  for (int i = -beside; i <= beside; ++i)
    for (int j = -above; j <= above; ++j)
      points.col(n++) = station.place + kPatchPixel * (i * station.beside + j * up);
  return points;
}

Eigen::MatrixXd drawn_leaflets(const Station& station, const Vec3& up, const TriangleMesh& leaflets) {
  const Vector distances =
      surface_distance(plane_points(station, up, kPatchBeside, kPatchAbove), leaflets).vertex_distances;
  Eigen::MatrixXd drawn = (-0.5 * (distances.array() / kDrawnSheet).square()).exp().matrix();
  return drawn.reshaped(2 * kPatchAbove + 1, 2 * kPatchBeside + 1);
}

Eigen::MatrixXd image_across(const Station& station, const Vec3& up, const Volume& volume) {
  const Points points = plane_points(station, up, kPatchBeside + kMostShift, kPatchAbove + kMostShift);
  Eigen::MatrixXd values(points.cols(), 1);
  for (Eigen::Index n = 0; n < points.cols(); ++n) {
    values(n) = 0;
    for (int k = -kAveragedSteps; k <= kAveragedSteps; ++k)
      values(n) +=
          sample(volume, points.col(n) + k * kLineStep * station.along, 0) / (2 * kAveragedSteps + 1);
  }
  return values.reshaped(2 * (kPatchAbove + kMostShift) + 1, 2 * (kPatchBeside + kMostShift) + 1);
}

// Of each shift, rows up and columns to the side. 0 where the image is the same everywhere.
Eigen::MatrixXd correlations(const Eigen::MatrixXd& image, Eigen::MatrixXd drawn) {
  drawn.array() -= drawn.mean();
  const double norm = drawn.norm();
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(2 * kMostShift + 1, 2 * kMostShift + 1);
  for (Eigen::Index up = 0; up < found.rows(); ++up)
    for (Eigen::Index side = 0; side < found.cols(); ++side) {
      const auto part = image.block(up, side, drawn.rows(), drawn.cols());
      const double spread = (part.array() - part.mean()).matrix().norm();
      if (spread > 0 && norm > 0) found(up, side) = part.cwiseProduct(drawn).sum() / (spread * norm);
    }
  return found;
}

// By a Gaussian over the places of a line.
Eigen::MatrixXd averaged_along(const std::vector<Eigen::MatrixXd>& all, Eigen::Index at) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(all.front().rows(), all.front().cols());
  double weights = 0;
  for (Eigen::Index n = 0; n < static_cast<Eigen::Index>(all.size()); ++n) {
    const double away = kLineStep * static_cast<double>(n - at) / kAlongLine;
    const double weight = std::exp(-0.5 * away * away);
    weights += weight;
    sum += weight * all[static_cast<size_t>(n)];
  }
  return sum / weights;
}

LineInImage piece_in_image(const Volume& closed, const TriangleMesh& leaflets, const Points& places,
                           const Vec3& up) {
  const std::vector<Station> stations = stations_on(places, up);
  std::vector<Eigen::MatrixXd> likeness;
  for (const Station& station : stations)
    likeness.push_back(
        correlations(image_across(station, up, closed), drawn_leaflets(station, up, leaflets)));
  LineInImage line;
  line.predicted = places;
  line.found.resize(3, places.cols());
  line.likeness.resize(places.cols());
  for (Eigen::Index n = 0; n < places.cols(); ++n) {
    Eigen::Index row = 0, column = 0;
    line.likeness[n] = averaged_along(likeness, n).maxCoeff(&row, &column);
    const auto rise = static_cast<int>(row) - kMostShift, aside = static_cast<int>(column) - kMostShift;
    line.found.col(n) =
        places.col(n) + kPatchPixel * (rise * up + aside * stations[static_cast<size_t>(n)].beside);
    line.is_shown.push_back(line.likeness[n] >= kLeastLikeness && std::abs(rise) < kMostShift &&
                            std::abs(aside) < kMostShift);
  }
  return line;
}

}  // namespace

std::vector<LineInImage> line_in_image(const Volume& closed, const TriangleMesh& leaflets,
                                       const std::vector<Points>& line, const Vec3& up) {
  std::vector<LineInImage> found;
  for (const Points& piece : line) {
    if (piece.cols() < 2) continue;
    const Points places = at_equal_steps(piece);
    if (kLineStep * static_cast<double>(places.cols() - 1) >= kShortestLine)
      found.push_back(piece_in_image(closed, leaflets, places, up));
  }
  return found;
}

}  // namespace coapt
