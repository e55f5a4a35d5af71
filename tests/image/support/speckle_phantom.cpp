#include "image/support/speckle_phantom.hpp"

#include "core/random_source.hpp"
#include "mesh/distance/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt::testing {
namespace {

constexpr double kBlood = 0.0316;  // amplitude over that of leaflets

Volume empty_around(const TriangleMesh& surface, const PhantomOptions& options) {
  Volume volume;
  volume.direction = options.direction;
  volume.spacing = Vec3::Constant(options.voxel);
  const Points turned = options.direction.transpose() * surface.vertices;
  const Vec3 low = turned.rowwise().minCoeff().array() - options.margin;
  const Vec3 high = turned.rowwise().maxCoeff().array() + options.margin;
  volume.origin = options.direction * low;
  size_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<size_t>(axis);
    volume.size[a] = static_cast<int>(std::ceil((high[axis] - low[axis]) / options.voxel)) + 1;
    count *= static_cast<size_t>(volume.size[a]);
  }
  volume.values.assign(count, 0);
  return volume;
}

double gaussian(RandomSource& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random.unit()));
  return radius * std::cos(2 * std::numbers::pi * random.unit());
}

// Whether a place lies beyond a rim of the surface: not straight above the place nearest to it.
bool is_beyond_rim(const TriangleMesh& surface, const ClosestOnSurface& found, const Vec3& x) {
  const Vec3 offset = x - found.point;
  const Vec3 normal = area_vector(surface.vertices, surface.triangles.col(found.triangle)).normalized();
  return std::abs(offset.dot(normal)) < 0.7 * offset.norm();
}

// 1 in the leaflets, partly at their sides, else 0; they end square at the rims.
Volume occupancy(const TriangleMesh& surface, const PhantomOptions& options) {
  Volume volume = empty_around(surface, options);
  const TriangleTree tree(surface.vertices, surface.triangles);
  const double reach = 0.5 * (options.thickness + options.voxel);
  for (int t = 0; t < surface.triangle_count(); ++t) {  // only near a triangle is there anything
    Vec3 low = Vec3::Constant(kInfinity), high = Vec3::Constant(-kInfinity);
    for (int k = 0; k < 3; ++k) {
      const Vec3 at = voxels_of(volume, surface.vertices.col(surface.triangles(k, t)));
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
    const double margin = reach / options.voxel;
    const Eigen::Vector3i first = (low.array() - margin).floor().cast<int>();
    const Eigen::Vector3i last = (high.array() + margin).ceil().cast<int>();
    for (int k = first[2]; k <= last[2]; ++k)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int i = first[0]; i <= last[0]; ++i) {
          float& value = volume.values[volume.voxel(i, j, k)];
          if (value != 0) continue;
          const Vec3 x = position_of(volume, Vec3(i, j, k));
          const ClosestOnSurface found = tree.closest(x);
          if (is_beyond_rim(surface, found, x)) continue;
          if (options.is_dropped_out && options.is_dropped_out(found.point)) continue;
          const double inside = (reach - std::sqrt(found.distance_squared)) / options.voxel;
          value = static_cast<float>(std::clamp(inside, 0.0, 1.0));
        }
  }
  return volume;
}

void blur_along(Volume& volume, int axis, double deviation) {
  const int reach = static_cast<int>(std::ceil(3 * deviation));
  std::vector<float> kernel;
  for (int k = -reach; k <= reach; ++k)
    kernel.push_back(static_cast<float>(std::exp(-0.5 * k * k / (deviation * deviation))));
  const Volume before = volume;
  std::array<int, 3> at{};
  for (at[2] = 0; at[2] < volume.size[2]; ++at[2])
    for (at[1] = 0; at[1] < volume.size[1]; ++at[1])
      for (at[0] = 0; at[0] < volume.size[0]; ++at[0]) {
        float sum = 0;
        std::array<int, 3> other = at;
        auto& moving = other[static_cast<size_t>(axis)];
        const int here = moving;
        for (int k = -reach; k <= reach; ++k) {
          moving = std::clamp(here + k, 0, volume.size[static_cast<size_t>(axis)] - 1);
          sum += kernel[static_cast<size_t>(k + reach)] *
                 before.values[before.voxel(other[0], other[1], other[2])];
        }
        volume.values[volume.voxel(at[0], at[1], at[2])] = sum;
      }
}

}  // namespace

Volume speckle_volume(const TriangleMesh& surface, const PhantomOptions& options) {
  const Volume inside = occupancy(surface, options);
  RandomSource random(options.seed);
  Volume real = volume_like(inside, 0), imaginary = real;
  for (size_t voxel = 0; voxel < inside.values.size(); ++voxel) {
    const double share = inside.values[voxel];
    const double amplitude = std::sqrt(share + (1 - share) * kBlood * kBlood);
    real.values[voxel] = static_cast<float>(amplitude * gaussian(random));
    imaginary.values[voxel] = static_cast<float>(amplitude * gaussian(random));
  }
  for (int axis = 0; axis < 3; ++axis) {
    blur_along(real, axis, options.spread / options.voxel);
    blur_along(imaginary, axis, options.spread / options.voxel);
  }
  for (size_t voxel = 0; voxel < real.values.size(); ++voxel)
    real.values[voxel] = std::hypot(real.values[voxel], imaginary.values[voxel]);
  std::vector<float> sorted = real.values;
  const auto bright = sorted.end() - static_cast<std::ptrdiff_t>(sorted.size() / 2000) - 1;
  std::nth_element(sorted.begin(), bright, sorted.end());
  const double greatest = *bright;
  for (float& value : real.values) {
    const double decibels = 20 * std::log10(std::max(value / greatest, 1e-9));
    value = static_cast<float>(std::round(std::clamp(255 * (1 + decibels / kPhantomRange), 0.0, 255.0)));
  }
  return real;
}

Volume plain_volume(const TriangleMesh& surface, const PhantomOptions& options) {
  Volume volume = occupancy(surface, options);
  RandomSource random(options.seed);
  for (float& value : volume.values) value = static_cast<float>(100 * value + 5 * gaussian(random));
  return volume;
}

}  // namespace coapt::testing
