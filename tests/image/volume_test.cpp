#include "image/volume.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>

namespace coapt {
namespace {

// An oblique, anisotropic grid whose values are linear in space: 2 x - y + 3 z.
Volume linear_volume() {
  Volume volume;
  volume.size = {5, 4, 3};
  volume.origin = Vec3(10, -20, 30);
  volume.spacing = Vec3(0.5, 0.7, 1.1);
  volume.direction = Eigen::AngleAxisd(0.4, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  volume.values.resize(60);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i)
        volume.values[volume.voxel(i, j, k)] =
            static_cast<float>(Vec3(2, -1, 3).dot(position_of(volume, Vec3(i, j, k))));
  return volume;
}

TEST(Volume, APositionComesBackThroughVoxels) {
  const Volume volume = linear_volume();
  const Vec3 voxels(1.25, 2.5, 0.75);
  EXPECT_LT((voxels_of(volume, position_of(volume, voxels)) - voxels).norm(), 1e-12);
}

TEST(Volume, SamplingIsExactForLinearValuesUpToTheLastCentre) {
  const Volume volume = linear_volume();
  for (const Vec3& voxels : {Vec3(1.25, 2.5, 0.75), Vec3(0, 0, 0), Vec3(4, 3, 2), Vec3(3.5, 0, 2)}) {
    const Vec3 position = position_of(volume, voxels);
    // The corners are where rounding may fall to either side; they are pulled in by a millionth of a voxel.
    const Vec3 inside = position_of(volume, voxels + 1e-6 * (Vec3(2, 1.5, 1) - voxels));
    EXPECT_NEAR(sample(volume, inside, -1), Vec3(2, -1, 3).dot(position), 1e-4);
  }
}

TEST(Volume, BeyondTheOutermostCentresIsOutside) {
  const Volume volume = linear_volume();
  EXPECT_EQ(sample(volume, position_of(volume, Vec3(-0.1, 1, 1)), -7), -7);
  EXPECT_EQ(sample(volume, position_of(volume, Vec3(1, 1, 2.1)), -7), -7);
  EXPECT_EQ(sample(volume, Vec3::Constant(kNaN), -7), -7);
}

}  // namespace
}  // namespace coapt
