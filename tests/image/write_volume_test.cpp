#include "image/write_volume.hpp"

#include "core/error.hpp"
#include "image/read_volume.hpp"
#include "support/temporary_folder.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace coapt {
namespace {

Volume oblique_volume() {
  Volume volume;
  volume.size = {4, 3, 5};
  volume.origin = Vec3(10, -20, 30);
  volume.spacing = Vec3(0.5, 0.7, 0.6);
  volume.direction = Eigen::AngleAxisd(0.7, Vec3(1, 2, -3).normalized()).toRotationMatrix();
  for (int k = 0; k < 60; ++k) volume.values.push_back(static_cast<float>(k) * 2.25F - 10);
  return volume;
}

TEST(WriteVolume, EveryFormatGivesBackWhatWasWritten) {
  const TemporaryFolder folder;
  const Volume volume = oblique_volume();
  for (const char* name : {"v.nrrd", "v.nii", "v.nii.gz", "v.mha"}) {
    const auto path = folder.path() / name;
    write_volume(path, volume, VoxelKind::Float32);
    const VolumeFile file = read_volume(path);
    EXPECT_EQ(file.kind, VoxelKind::Float32);
    EXPECT_EQ(file.volume.values, volume.values) << name;
    for (const Vec3& voxels : {Vec3(0, 0, 0), Vec3(3, 2, 4)})
      EXPECT_LT((position_of(file.volume, voxels) - position_of(volume, voxels)).norm(), 1e-5) << name;
    EXPECT_TRUE(file.warnings.empty()) << name;
    const std::string bytes = text_of(path);
    write_volume(path, volume, VoxelKind::Float32);
    EXPECT_EQ(text_of(path), bytes) << name;
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 4);
}

TEST(WriteVolume, WholeNumbersAreRoundedAndKeptWithinTheirKind) {
  const TemporaryFolder folder;
  Volume volume = oblique_volume();
  volume.values[0] = -1000;
  volume.values[1] = 1000;
  volume.values[2] = 17.6F;
  write_volume(folder.path() / "v.nrrd", volume, VoxelKind::UInt8);
  const VolumeFile file = read_volume(folder.path() / "v.nrrd");
  EXPECT_EQ(file.kind, VoxelKind::UInt8);
  EXPECT_EQ(file.volume.values[0], 0);
  EXPECT_EQ(file.volume.values[1], 255);
  EXPECT_EQ(file.volume.values[2], 18);
}

TEST(WriteVolume, WhatCannotBeWrittenIsSaidAndLeavesNothing) {
  const TemporaryFolder folder;
  Volume volume = oblique_volume();
  EXPECT_THROW(write_volume(folder.path() / "v.png", volume, VoxelKind::UInt8), InputError);
  EXPECT_THROW(write_volume(folder.path() / "none/v.nrrd", volume, VoxelKind::UInt8), InputError);
  volume.values[5] = static_cast<float>(kNaN);
  EXPECT_THROW(write_volume(folder.path() / "v.nrrd", volume, VoxelKind::Float32), InputError);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace coapt
