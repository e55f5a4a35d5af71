#include "image/read_volume.hpp"

#include "image/hand_made_files.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

void expect_near(const Vec3& found, const Vec3& wanted) {
  EXPECT_LT((found - wanted).norm(), 1e-5) << found.transpose() << " instead of " << wanted.transpose();
}

void expect_counted(const Volume& volume, float first = 0, float step = 1) {
  ASSERT_EQ(volume.values.size(), 24u);
  for (std::size_t k = 0; k < 24; ++k) EXPECT_EQ(volume.values[k], first + step * static_cast<float>(k));
}

TEST(ReadVolume, NrrdInLpsStaysAndInRasOrLasIsTurned) {
  const TemporaryFolder folder;
  for (const auto& [space, x, y] :
       {std::tuple{"left-posterior-superior", 1.0, 1.0}, std::tuple{"right-anterior-superior", -1.0, -1.0},
        std::tuple{"LAS", 1.0, -1.0}}) {
    const auto path = folder.write("v.nrrd", nrrd(turned_nrrd_fields(space), counted<std::uint8_t>(24)));
    const VolumeFile file = read_volume(path);
    EXPECT_EQ(file.format, "NRRD");
    EXPECT_EQ(file.kind, VoxelKind::UInt8);
    EXPECT_EQ(file.volume.size, (std::array{2, 3, 4}));
    EXPECT_TRUE(file.warnings.empty()) << file.warnings[0];
    expect_near(file.volume.spacing, Vec3(0.5, 0.6, 0.7));
    const Vec3 sign(x, y, 1);
    expect_near(position_of(file.volume, Vec3(0, 0, 0)), sign.cwiseProduct(Vec3(10, 20, 30)));
    expect_near(position_of(file.volume, Vec3(1, 2, 3)), sign.cwiseProduct(Vec3(8.8, 20.5, 32.1)));
    expect_counted(file.volume);
  }
}

TEST(ReadVolume, SequenceOfSlicerGivesTheFrameThatIsChosen) {
  const TemporaryFolder folder;
  const std::string fields =
      "type: int16\ndimension: 4\nspace: right-anterior-superior\nsizes: 3 2 3 4\n"
      "space directions: none (1,0,0) (0,2,0) (0,0,3)\nkinds: list domain domain domain\n"
      "space origin: (1,2,3)\n";
  const auto path = folder.write("v.seq.nrrd", nrrd(fields, counted<std::int16_t>(72)));
  EXPECT_EQ(read_volume_header(path).frames, 3);
  for (int frame = 0; frame < 3; ++frame) {
    const VolumeFile file = read_volume(path, {.frame = frame, .spacing = {}});
    expect_counted(file.volume, static_cast<float>(frame), 3);  // the frame runs fastest
    expect_near(position_of(file.volume, Vec3(1, 1, 1)), Vec3(-2, -4, 6));
  }
}

TEST(ReadVolume, SequenceWhoseFramesLieBehindEachOtherGivesTheOneThatIsChosen) {
  const TemporaryFolder folder;
  const std::string fields =
      "type: uint8\ndimension: 4\nspace: left-posterior-superior\nsizes: 2 3 4 2\n"
      "space directions: (1,0,0) (0,2,0) (0,0,3) none\nkinds: domain domain domain list\nspace origin: "
      "(1,2,3)\n";
  const auto path = folder.write("v.nrrd", nrrd(fields, counted<std::uint8_t>(48)));
  expect_counted(read_volume(path, {.frame = 1, .spacing = {}}).volume, 24);
  NiftiHeader header;
  header.dim = {4, 2, 3, 4, 2, 1, 1, 1};
  header.sform_code = 1;
  header.srow = {0.5F, 0, 0, 0, 0, 0.6F, 0, 0, 0, 0, 0.7F, 0};
  const auto other = folder.write("v.nii", nifti(header, counted<std::uint8_t>(48)));
  EXPECT_EQ(read_volume_header(other).frames, 2);
  expect_counted(read_volume(other, {.frame = 1, .spacing = {}}).volume, 24);
}

TEST(ReadVolume, NiftiInRasIsTurnedToLpsByItsRowsAndByItsQuaternion) {
  const TemporaryFolder folder;
  NiftiHeader header;
  header.sform_code = 1;
  header.srow = {0, -0.6F, 0, 10, 0.5F, 0, 0, 20, 0, 0, 0.7F, 30};
  NiftiHeader other;
  other.qform_code = 1;
  other.quaternion_and_offset = {0, 0, 0.70710678F, 10, 20, 30};  // 90 degrees about z, as the rows
  for (const NiftiHeader& one : {header, other}) {
    const VolumeFile file = read_volume(folder.write("v.nii", nifti(one, counted<std::uint8_t>(24))));
    EXPECT_TRUE(file.warnings.empty());
    expect_near(file.volume.spacing, Vec3(0.5, 0.6, 0.7));
    expect_near(position_of(file.volume, Vec3(0, 0, 0)), Vec3(-10, -20, 30));
    expect_near(position_of(file.volume, Vec3(1, 2, 3)), Vec3(-8.8, -20.5, 32.1));
    expect_counted(file.volume);
  }
}

TEST(ReadVolume, MetaImageIsInLpsWithOneAxisPerRowOfItsMatrix) {
  const TemporaryFolder folder;
  const auto path = folder.write(
      "v.mha",
      meta_image("NDims = 3\nDimSize = 2 3 4\nElementType = MET_SHORT\nElementSpacing = 0.5 0.6 0.7\n"
                 "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 10 20 30\n",
                 counted<std::int16_t>(24)));
  const VolumeFile file = read_volume(path);
  EXPECT_EQ(file.kind, VoxelKind::Int16);
  EXPECT_TRUE(file.warnings.empty());
  expect_near(position_of(file.volume, Vec3(1, 2, 3)), Vec3(8.8, 20.5, 32.1));
  expect_counted(file.volume);
}

TEST(ReadVolume, WhatIsAssumedOfAFileThatSaysLittleIsWarnedOf) {
  const TemporaryFolder folder;
  const auto path = folder.write(
      "v.nrrd",
      nrrd("type: uint8\ndimension: 3\nsizes: 2 3 4\nspacings: 0.5 0.5 2\n", counted<std::uint8_t>(24)));
  const VolumeFile file = read_volume(path);
  ASSERT_EQ(file.warnings.size(), 2u);
  EXPECT_NE(file.warnings[0].find("does not say how its axes lie"), std::string::npos);
  EXPECT_NE(file.warnings[1].find("4 times as long as wide"), std::string::npos);
  expect_near(file.volume.spacing, Vec3(0.5, 0.5, 2));
  const std::string no_space =
      "type: uint8\ndimension: 3\nspace dimension: 3\nsizes: 2 3 4\nspace directions: (1,0,0) (0,1,0) "
      "(0,0,1)\n";
  const auto other = folder.write("w.nrrd", nrrd(no_space, counted<std::uint8_t>(24)));
  ASSERT_EQ(read_volume(other).warnings.size(), 1u);
  EXPECT_NE(read_volume(other).warnings[0].find("LPS is assumed"), std::string::npos);
  const auto nii = folder.write("v.nii", nifti({}, counted<std::uint8_t>(24)));
  ASSERT_EQ(read_volume(nii).warnings.size(), 1u);
  EXPECT_NE(read_volume(nii).warnings[0].find("does not say how its axes lie"), std::string::npos);
}

TEST(ReadVolume, SpacingThatIsMissingCanBeGiven) {
  const TemporaryFolder folder;
  const auto path =
      folder.write("v.nrrd", nrrd("type: uint8\ndimension: 3\nsizes: 2 3 4\n", counted<std::uint8_t>(24)));
  EXPECT_FALSE(read_volume_header(path).states_spacing);
  const VolumeFile file = read_volume(path, {.frame = {}, .spacing = Vec3(0.5, 0.5, 0.5)});
  EXPECT_TRUE(file.states_spacing);
  expect_near(file.volume.spacing, Vec3(0.5, 0.5, 0.5));
}

TEST(ReadVolume, TheRealHeartIsRead) {
  const std::filesystem::path folder = std::filesystem::path(COAPT_SHARED_DIR) / "data/hipct-heart-635um";
  if (!std::filesystem::exists(folder))
    GTEST_SKIP() << "the volume of a real heart is not here: " << folder.string();
  const VolumeFile file = read_volume(folder / "heart_635um.nrrd");
  EXPECT_EQ(file.kind, VoxelKind::UInt16);
  EXPECT_EQ(file.volume.size, (std::array{149, 157, 235}));
  expect_near(file.volume.spacing, Vec3::Constant(0.6352));
  ASSERT_EQ(file.warnings.size(), 1u);  // it does not say in which space
  const VolumeFile crop = read_volume(folder / "valve_plane_crop.mhd");
  EXPECT_EQ(crop.volume.size, (std::array{149, 157, 90}));
  for (const Vec3& voxels : {Vec3(70, 80, 0), Vec3(20, 100, 45), Vec3(148, 156, 89)}) {
    const Vec3 position = position_of(crop.volume, voxels);
    EXPECT_EQ(crop.volume.values[crop.volume.voxel(int(voxels[0]), int(voxels[1]), int(voxels[2]))],
              file.volume.values[file.volume.voxel(int(voxels[0]), int(voxels[1]), int(voxels[2]) + 60)]);
    expect_near(position, position_of(file.volume, voxels + Vec3(0, 0, 60)));
  }
  const VolumeFile mask = read_volume(folder / "heart_mask_635um.nrrd");
  EXPECT_EQ(mask.volume.size, file.volume.size);
}

}  // namespace
}  // namespace coapt
