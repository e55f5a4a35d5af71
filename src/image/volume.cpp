#include "image/volume.hpp"

#include <algorithm>

namespace coapt {

Volume volume_like(const Volume& grid, float value) {
  Volume volume;
  volume.size = grid.size;
  volume.origin = grid.origin;
  volume.spacing = grid.spacing;
  volume.direction = grid.direction;
  volume.values.assign(grid.values.size(), value);
  return volume;
}

Vec3 position_of(const Volume& volume, const Vec3& voxels) {
  return volume.origin + volume.direction * voxels.cwiseProduct(volume.spacing);
}

Vec3 voxels_of(const Volume& volume, const Vec3& position) {
  return (volume.direction.transpose() * (position - volume.origin)).cwiseQuotient(volume.spacing);
}

double sample(const Volume& volume, const Vec3& position, double outside) {
  const Vec3 at = voxels_of(volume, position);
  int low[3];
  double share[3];
  for (int axis = 0; axis < 3; ++axis) {
    const int last = volume.size[axis] - 1;
    if (!(at[axis] >= 0 && at[axis] <= last)) return outside;
    low[axis] = std::min(static_cast<int>(at[axis]), std::max(last - 1, 0));
    share[axis] = at[axis] - low[axis];
  }
  double value = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int voxel[3];
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = (corner >> axis) & 1;
      weight *= upper ? share[axis] : 1 - share[axis];
      voxel[axis] = low[axis] + (upper ? 1 : 0);
    }
    if (weight > 0) value += weight * volume.values[volume.voxel(voxel[0], voxel[1], voxel[2])];
  }
  return value;
}

}  // namespace coapt
