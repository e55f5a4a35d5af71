#include "image/segment/speckle_blur.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kFar = 3.5;                // where speckle is no longer correlated [mm]
constexpr int kLeastPairs = 200;            // of voxels, below which an axis says nothing
constexpr double kLeastCorrelation = 0.02;  // of neighbours, below which nothing is said
constexpr int kTerms = 60;                  // of the dilogarithm's series

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

struct Variogram {
  double sum = 0;
  int count = 0;
  double value() const { return sum / count; }
};

// Between voxels that count, `lag` apart along an axis.
Variogram variogram(const Volume& volume, const std::vector<char>& is_counted, int axis, int lag) {
  Variogram pairs;
  std::array<int, 3> last = volume.size;
  last[static_cast<size_t>(axis)] -= lag;
  const size_t step = axis == 0   ? volume.voxel(lag, 0, 0)
                      : axis == 1 ? volume.voxel(0, lag, 0)
                                  : volume.voxel(0, 0, lag);
  for (int k = 0; k < last[2]; ++k)
    for (int j = 0; j < last[1]; ++j)
      for (int i = 0; i < last[0]; ++i) {
        const size_t voxel = volume.voxel(i, j, k);
        if (!is_counted[voxel] || !is_counted[voxel + step]) continue;
        const double difference = static_cast<double>(volume.values[voxel]) - volume.values[voxel + step];
        pairs.sum += 0.5 * difference * difference;
        ++pairs.count;
      }
  return pairs;
}

}  // namespace

std::optional<Vec3> speckle_blur(const Volume& volume, const LayerGrid& grid,
                                 const std::vector<char>& points) {
  std::vector<char> is_counted(volume.values.size(), 0);
  for (Eigen::Index node = 0; node < grid.points.cols(); ++node) {
    if (!points[static_cast<size_t>(node)] || std::isnan(sample(volume, grid.points.col(node), kNaN)))
      continue;
    const Vec3 at = voxels_of(volume, grid.points.col(node));
    is_counted[volume.voxel(static_cast<int>(std::lround(at[0])), static_cast<int>(std::lround(at[1])),
                            static_cast<int>(std::lround(at[2])))] = 1;
  }
  Vec3 blur = Vec3::Constant(kNaN);
  double sum = 0;
  int known = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double voxel = volume.spacing[axis];
    const Variogram near = variogram(volume, is_counted, axis, 1);
    const Variogram far = variogram(volume, is_counted, axis, static_cast<int>(std::ceil(kFar / voxel)));
    if (near.count < kLeastPairs || far.count < kLeastPairs || !(far.sum > 0)) continue;
    const double correlation = 1 - near.value() / far.value();
    if (!(correlation > kLeastCorrelation && correlation < 1)) continue;
    blur[axis] = voxel / std::sqrt(-4 * std::log(field_correlation(correlation)));
    sum += blur[axis];
    ++known;
  }
  if (known == 0) return std::nullopt;
  for (int axis = 0; axis < 3; ++axis)
    if (std::isnan(blur[axis])) blur[axis] = sum / known;
  return blur;
}

}  // namespace coapt
