#include "core/error.hpp"
#include "image/hand_made_files.hpp"
#include "image/read_volume.hpp"
#include "image/write_volume.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace coapt {
namespace {

// What reading says of a file, in one line.
std::string refusal(const std::filesystem::path& path, const VolumeReadOptions& options = {}) {
  try {
    read_volume(path, options);
  } catch (const InputError& error) {
    EXPECT_EQ(error.defects().size(), 1u);
    EXPECT_NE(error.defects()[0].find(path.filename().string()), std::string::npos) << error.what();
    EXPECT_EQ(error.defects()[0].find('\n'), std::string::npos);
    return error.what();
  }
  return "was read";
}

void expect_says(const std::string& text, const std::string& reason, const std::string& remedy) {
  EXPECT_NE(text.find(reason), std::string::npos) << text;
  EXPECT_NE(text.find(remedy), std::string::npos) << text;
}

const std::string kLps = "type: uint8\ndimension: 3\nspace: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n";

TEST(BadVolume, PathsThatAreNoFileOfAVolume) {
  const TemporaryFolder folder;
  expect_says(refusal(folder.path() / "none.nrrd"), "does not exist", "");
  expect_says(refusal(folder.write("v.png", "PNG")), "by its name", "convert it");
  for (const char* name : {"v.nrrd", "v.nii", "v.nii.gz", "v.mha", "v.dcm"}) {
    expect_says(refusal(folder.write(name, "")), "is empty", "again");
    expect_says(refusal(folder.write(name, "This is a text.\n")), "", "export it again");
  }
}

TEST(BadVolume, AxesThatAreNoNumbers) {
  const TemporaryFolder folder;
  NiftiHeader header;
  header.sform_code = 1;
  const float nan = std::numeric_limits<float>::quiet_NaN(), most = std::numeric_limits<float>::max();
  for (const float wrong : {nan, most}) {
    header.srow = {0.5F, 0, 0, 0, wrong, 0.6F, 0, wrong, 0, 0, 0.7F, 0};
    const auto path = folder.write("v.nii", nifti(header, counted<std::uint8_t>(24)));
    expect_says(refusal(path), "v.nii", std::isnan(wrong) ? "export it again" : "");
  }
}

TEST(BadVolume, FilesThatEndTooEarly) {
  const TemporaryFolder folder;
  const std::string half = counted<std::uint8_t>(12);
  expect_says(refusal(folder.write("v.nrrd", nrrd(turned_nrrd_fields("LPS"), half))), "cannot be read",
              "again");
  NiftiHeader header;
  header.sform_code = 1;
  header.srow = {0.5F, 0, 0, 0, 0, 0.6F, 0, 0, 0, 0, 0.7F, 0};
  expect_says(refusal(folder.write("v.nii", nifti(header, half))), "cannot be read", "again");
  Volume volume;
  volume.size = {40, 40, 40};
  for (int k = 0; k < 64000; ++k) volume.values.push_back(static_cast<float>(k * 7919 % 251));
  write_volume(folder.path() / "packed.nii.gz", volume, VoxelKind::UInt8);
  const std::string packed = text_of(folder.path() / "packed.nii.gz");
  expect_says(refusal(folder.write("v.nii.gz", packed.substr(0, packed.size() / 2))), "cannot be read",
              "again");
  expect_says(refusal(folder.write("w.nii", nifti(header, half).substr(0, 200))), "", "again");
  const std::string fields = "NDims = 3\nDimSize = 2 3 4\nElementType = MET_UCHAR\nElementSpacing = 1 1 1\n";
  expect_says(refusal(folder.write("v.mha", meta_image(fields, half))), "cannot be read", "again");
  expect_says(refusal(folder.write("w.nrrd", "NRRD0005\ntype: uint8\ndim")), "header cannot be read", "");
}

TEST(BadVolume, HeadersThatPromiseTooMuchAreRefusedBeforeAnythingIsAllocated) {
  const TemporaryFolder folder;
  const auto path = folder.write("v.nrrd", nrrd(kLps + "sizes: 10000 10000 10000\n", "few"));
  expect_says(refusal(path), "promises 1e+12 voxels", "crop it");
  const std::string meta =
      "NDims = 3\nDimSize = 10000 10000 10000\nElementType = MET_UCHAR\nElementSpacing = 1 1 1\n";
  expect_says(refusal(folder.write("v.mha", meta_image(meta, "few"))), "promises 1e+12 voxels", "crop it");
  NiftiHeader header;
  header.dim = {3, 10000, 10000, 10000, 1, 1, 1, 1};
  expect_says(refusal(folder.write("v.nii", nifti(header, "few"))), "promises 1e+12 voxels", "crop it");
}

TEST(BadVolume, OtherDimensionsAndOtherThingsThanGreyValues) {
  const TemporaryFolder folder;
  const auto flat = folder.write(
      "flat.nrrd", nrrd("type: uint8\ndimension: 2\nsizes: 2 3\nspacings: 1 1\n", counted<std::uint8_t>(6)));
  expect_says(refusal(flat), "flat image of 2 x 3", "a volume is needed");
  const auto colours = folder.write(
      "colours.nrrd",
      nrrd("type: uint8\ndimension: 4\nspace: LPS\nsizes: 3 2 3 4\nkinds: RGB-color domain domain domain\n"
           "space directions: none (1,0,0) (0,1,0) (0,0,1)\n",
           counted<std::uint8_t>(72)));
  expect_says(refusal(colours), "rgbs of 3 numbers", "grey values alone");
  const auto vectors = folder.write(
      "vectors.nrrd",
      nrrd("type: uint8\ndimension: 4\nspace: LPS\nsizes: 3 2 3 4\nkinds: vector domain domain domain\n"
           "space directions: none (1,0,0) (0,1,0) (0,0,1)\n",
           counted<std::uint8_t>(72)));
  expect_says(refusal(vectors), "vectors of 3 numbers", "grey values alone");
  expect_says(refusal(folder.write("slice.dcm", dicom({}, counted<std::uint16_t>(6)))), "flat image",
              "folder");
}

TEST(BadVolume, ATimeSeriesWantsAFrameAndASingleVolumeHasOne) {
  const TemporaryFolder folder;
  const auto series = folder.write(
      "v.seq.nrrd",
      nrrd("type: uint8\ndimension: 4\nspace: LPS\nsizes: 3 2 3 4\nkinds: list domain domain domain\n"
           "space directions: none (1,0,0) (0,1,0) (0,0,1)\n",
           counted<std::uint8_t>(72)));
  expect_says(refusal(series), "time series of 3 frames", "--frame, from 0 to 2");
  expect_says(refusal(series, {.frame = 3, .spacing = {}}), "no frame 3", "from 0 to 2");
  const auto single = folder.write("v.nrrd", nrrd(kLps + "sizes: 2 3 4\n", counted<std::uint8_t>(24)));
  expect_says(refusal(single, {.frame = 1, .spacing = {}}), "no frame 1", "frame 0");
}

TEST(BadVolume, VoxelsThatAreNoNumbersAreCountedAndPlaced) {
  const TemporaryFolder folder;
  std::string data = counted<float>(24);
  data.replace(9 * 4, 4, bytes_of(std::numeric_limits<float>::quiet_NaN()));
  data.replace(20 * 4, 4, bytes_of(std::numeric_limits<float>::infinity()));
  const std::string fields =
      "type: float\ndimension: 3\nspace: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n";
  const auto path = folder.write("v.nrrd", nrrd(fields + "sizes: 2 3 4\n", data));
  expect_says(refusal(path), "2 of 24 voxels are no finite numbers, the first is (1, 1, 1)",
              "give them a value");
}

TEST(BadVolume, GridsThatAreSkewOrFlatOrSayNoSpacing) {
  const TemporaryFolder folder;
  const std::string skew =
      "type: uint8\ndimension: 3\nspace: LPS\nsizes: 2 3 4\nspace directions: (1,0,0) (0.2,1,0) (0,0,1)\n";
  expect_says(refusal(folder.write("v.nrrd", nrrd(skew, counted<std::uint8_t>(24)))), "not orthogonal",
              "resample");
  const std::string meta = "NDims = 3\nDimSize = 2 3 4\nElementType = MET_UCHAR\nElementSpacing = 1 0 1\n";
  expect_says(refusal(folder.write("v.mha", meta_image(meta, counted<std::uint8_t>(24)))), "spacing", "");
  const std::string flat =
      "type: uint8\ndimension: 3\nspace: LPS\nsizes: 2 3 4\nspace directions: (1,0,0) (0,0,0) (0,0,1)\n";
  expect_says(refusal(folder.write("w.nrrd", nrrd(flat, counted<std::uint8_t>(24)))), "", "");
  const std::string unknown = "NDims = 3\nDimSize = 2 3 4\nElementType = MET_UCHAR\n";
  expect_says(refusal(folder.write("u.mha", meta_image(unknown, counted<std::uint8_t>(24)))),
              "does not say how large its voxels are", "--spacing");
}

}  // namespace
}  // namespace coapt
