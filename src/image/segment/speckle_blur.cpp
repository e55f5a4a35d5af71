#include "image/segment/speckle_blur.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr int kLeastPairs = 200;               // of voxels, below which an axis says nothing
constexpr double kLeastCorrelation = 0.02;     // of neighbours, below which nothing is said
constexpr double kGreatestCorrelation = 0.98;  // of neighbours, beyond which the blur is without bound
// In pairs of voxels, how much speaks against a blur that is not the same everywhere.
constexpr double kSlopePairs = 200;
constexpr int kTerms = 60;   // of the dilogarithm's series
constexpr int kBetween = 3;  // places from one point of the layer to the next
// Cosine of the angle between layer and axis, squared, up to which neighbours along it count: across a thin
// sheet speckle hardly changes.
constexpr double kMostAcross = 0.25;
constexpr double kCube = 4;                // that is looked at for speckle [mm]
constexpr double kSpeckleTolerance = 0.3;  // of its variance, relative
constexpr double kMostDark = 0.01;         // share of voxels with the least value of all

double dilogarithm(double x) {
  double sum = 0, power = 1;
  for (int k = 1; k <= kTerms; ++k) sum += (power *= x) / (k * k);
  return sum;
}

// The squared correlation of the field at which its logarithm has this one.
double field_correlation(double of_logarithms) {
  double low = 0, high = 1;
  for (int k = 0; k < 40; ++k) {
    const double middle = 0.5 * (low + high);
    (dilogarithm(middle) * 6 / (std::numbers::pi * std::numbers::pi) < of_logarithms ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Bit 3: the voxel is on the layer; bits 0 to 2: and the layer runs along this axis there.
std::vector<char> voxels_on_layer(const Volume& volume, const LayerGrid& grid,
                                  const std::vector<char>& points) {
  std::vector<char> marks(volume.values.size(), 0);
  const auto mark = [&](const Vec3& x, const Vec3& normal) {
    if (std::isnan(sample(volume, x, kNaN))) return;
    const Vec3 at = voxels_of(volume, x), across = volume.direction.transpose() * normal;
    char& here =
        marks[volume.voxel(static_cast<int>(std::lround(at[0])), static_cast<int>(std::lround(at[1])),
                           static_cast<int>(std::lround(at[2])))];
    here |= 8;
    for (int axis = 0; axis < 3; ++axis)
      if (across[axis] * across[axis] < kMostAcross) here = static_cast<char>(here | 1 << axis);
  };
  for (int row = 0; row + 1 < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      if (!points[static_cast<size_t>(grid.node(column, row))] ||
          !points[static_cast<size_t>(grid.node(column + 1, row + 1))])
        continue;
      for (int k = 0; k < kBetween * kBetween; ++k) {
        const double u = static_cast<double>(k % kBetween) / kBetween,
                     v = static_cast<double>(k / kBetween) / kBetween;
        mark((1 - v) * ((1 - u) * grid.at(column, row) + u * grid.at(column + 1, row)) +
                 v * ((1 - u) * grid.at(column, row + 1) + u * grid.at(column + 1, row + 1)),
             grid.normals.col(grid.node(column, row)));
      }
    }
  return marks;
}

double speckle_variance(const GreyScale& scale) {
  const double deviation = 10 / std::numbers::ln10 * std::numbers::pi / std::sqrt(6.0);  // 5.57 dB
  return std::pow(deviation / scale.decibels_per_value, 2);
}

struct Spread {
  double sum = 0, squares = 0, count = 0, darkest = 0;

  void add(double value, double least) {
    sum += value;
    squares += value * value;
    ++count;
    if (value <= least) ++darkest;
  }
  double variance() const { return count > 0 ? squares / count - sum * sum / (count * count) : 0; }
};

// Marks cubes that vary as speckle of one strength does: muscle, mostly. Where it is so dark that values are
// cut off it cannot be told.
void mark_speckle(const Volume& volume, const GreyScale& scale, std::vector<char>& marks) {
  const double wanted = speckle_variance(scale);
  const double least = *std::min_element(volume.values.begin(), volume.values.end());
  std::array<int, 3> edge;
  for (size_t axis = 0; axis < 3; ++axis)
    edge[axis] = std::max(2, static_cast<int>(std::lround(kCube / volume.spacing[static_cast<int>(axis)])));
  const auto for_voxels = [&](const std::array<int, 3>& first, const auto& see) {
    for (int k = first[2]; k < first[2] + edge[2]; ++k)
      for (int j = first[1]; j < first[1] + edge[1]; ++j)
        for (int i = first[0]; i < first[0] + edge[0]; ++i) see(volume.voxel(i, j, k));
  };
  std::array<int, 3> at{};
  for (at[2] = 0; at[2] + edge[2] <= volume.size[2]; at[2] += edge[2])
    for (at[1] = 0; at[1] + edge[1] <= volume.size[1]; at[1] += edge[1])
      for (at[0] = 0; at[0] + edge[0] <= volume.size[0]; at[0] += edge[0]) {
        Spread spread;
        for_voxels(at, [&](size_t voxel) { spread.add(volume.values[voxel], least); });
        const bool is_speckle = std::abs(spread.variance() / wanted - 1) < kSpeckleTolerance &&
                                spread.darkest < kMostDark * spread.count;
        if (is_speckle) for_voxels(at, [&](size_t voxel) { marks[voxel] |= 7; });
      }
}

// 1 and the place in the volume, -1 to 1 along each axis.
Eigen::Vector4d place_terms(const std::array<int, 3>& size, const Vec3& voxels) {
  Eigen::Vector4d terms = Eigen::Vector4d::Ones();
  for (int axis = 0; axis < 3; ++axis)
    terms[axis + 1] = 2 * voxels[axis] / std::max(size[static_cast<size_t>(axis)] - 1, 1) - 1;
  return terms;
}

// Of neighbouring voxels along an axis, half the mean squared difference as a linear function of the place,
// by least squares; nothing where there are too few.
std::optional<Eigen::Vector4d> variogram(const Volume& volume, const std::vector<char>& marks, int axis) {
  Eigen::Matrix4d matrix = Eigen::Vector4d(0, kSlopePairs, kSlopePairs, kSlopePairs).asDiagonal();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  std::array<int, 3> last = volume.size;
  --last[static_cast<size_t>(axis)];
  const size_t step = axis == 0   ? volume.voxel(1, 0, 0)
                      : axis == 1 ? volume.voxel(0, 1, 0)
                                  : volume.voxel(0, 0, 1);
  for (int k = 0; k < last[2]; ++k)
    for (int j = 0; j < last[1]; ++j)
      for (int i = 0; i < last[0]; ++i) {
        const size_t voxel = volume.voxel(i, j, k);
        if (!(marks[voxel] & marks[voxel + step] & 1 << axis)) continue;
        const double difference = static_cast<double>(volume.values[voxel]) - volume.values[voxel + step];
        const Eigen::Vector4d terms = place_terms(volume.size, Vec3(i, j, k));
        matrix += terms * terms.transpose();
        right += 0.5 * difference * difference * terms;
      }
  if (matrix(0, 0) < kLeastPairs) return std::nullopt;
  return Eigen::Vector4d(matrix.ldlt().solve(right));
}

// Of speckle: in decibels the logarithm of an exponentially distributed power; less where the image was
// smoothed, which the variance on the layer shows.
double variance_on_layer(const Volume& volume, const std::vector<char>& marks, const GreyScale& scale) {
  Spread spread;
  for (size_t voxel = 0; voxel < marks.size(); ++voxel)
    if (marks[voxel] & 8) spread.add(volume.values[voxel], -kInfinity);
  return std::min(spread.variance(), speckle_variance(scale));
}

}  // namespace

Vec3 SpeckleBlur::at(const Vec3& position) const {
  const Eigen::Vector4d terms = place_terms(frame.size, voxels_of(frame, position));
  Vec3 blur = Vec3::Constant(kNaN);
  double sum = 0;
  int known = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::optional<Eigen::Vector4d>& near = variograms[static_cast<size_t>(axis)];
    if (!near) continue;
    const double correlation =
        std::clamp(1 - near->dot(terms) / variance, kLeastCorrelation, kGreatestCorrelation);
    blur[axis] = frame.spacing[axis] / std::sqrt(-4 * std::log(field_correlation(correlation)));
    sum += blur[axis];
    ++known;
  }
  for (int axis = 0; axis < 3; ++axis)
    if (std::isnan(blur[axis])) blur[axis] = sum / known;
  return blur;
}

std::optional<SpeckleBlur> speckle_blur(const Volume& volume, const LayerGrid& grid,
                                        const std::vector<char>& points, const GreyScale& scale) {
  std::vector<char> marks = voxels_on_layer(volume, grid, points);
  SpeckleBlur blur;
  blur.frame.size = volume.size;
  blur.frame.origin = volume.origin;
  blur.frame.spacing = volume.spacing;
  blur.frame.direction = volume.direction;
  blur.variance = variance_on_layer(volume, marks, scale);
  if (!(blur.variance > 0)) return std::nullopt;
  mark_speckle(volume, scale, marks);
  for (int axis = 0; axis < 3; ++axis) {
    std::optional<Eigen::Vector4d> near = variogram(volume, marks, axis);
    if (near && 1 - (*near)[0] / blur.variance > kLeastCorrelation)
      blur.variograms[static_cast<size_t>(axis)] = near;
  }
  const auto is_known = [](const std::optional<Eigen::Vector4d>& near) { return near.has_value(); };
  if (std::none_of(blur.variograms.begin(), blur.variograms.end(), is_known)) return std::nullopt;
  return blur;
}

}  // namespace coapt
