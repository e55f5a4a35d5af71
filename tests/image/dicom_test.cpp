#include "core/error.hpp"
#include "image/hand_made_files.hpp"
#include "image/read_volume.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

// Slices whose rows run along y and whose columns run along -x, 0.7 mm from each other along z, in files
// whose names are in another order than the slices.
void write_series(const TemporaryFolder& folder, const std::vector<double>& heights) {
  for (std::size_t k = 0; k < heights.size(); ++k) {
    DicomSlice slice;
    slice.number = static_cast<int>(heights.size() - k);
    slice.position = "10\\20\\" + std::to_string(heights[k]).substr(0, 6);
    slice.orientation = "0\\1\\0\\-1\\0\\0";
    std::string data;
    for (int v = 0; v < 6; ++v) data += bytes_of(static_cast<std::uint16_t>(v + 6 * static_cast<int>(k)));
    folder.write("slice" + std::to_string(9 - k), dicom(slice, data));
  }
}

std::string series_refusal(const std::filesystem::path& path) {
  try {
    read_volume(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "was read";
}

TEST(DicomSeries, FilesOfAFolderAreStackedByTheirPlaces) {
  const TemporaryFolder folder;
  write_series(folder, {30, 30.7, 31.4, 32.1});
  const VolumeFile file = read_volume(folder.path());
  EXPECT_EQ(file.format, "DICOM");
  EXPECT_EQ(file.kind, VoxelKind::UInt16);
  EXPECT_EQ(file.volume.size, (std::array{2, 3, 4}));
  EXPECT_TRUE(file.warnings.empty());
  EXPECT_LT((position_of(file.volume, Vec3(0, 0, 0)) - Vec3(10, 20, 30)).norm(), 1e-6);
  EXPECT_LT((position_of(file.volume, Vec3(1, 2, 3)) - Vec3(8.8, 20.5, 32.1)).norm(), 1e-6);
  ASSERT_EQ(file.volume.values.size(), 24u);
  for (std::size_t k = 0; k < 24; ++k) EXPECT_EQ(file.volume.values[k], static_cast<float>(k));
}

TEST(DicomSeries, AMissingSliceIsNamed) {
  const TemporaryFolder folder;
  write_series(folder, {30, 30.7, 32.1, 32.8});
  EXPECT_NE(series_refusal(folder.path()).find("does not lie evenly"), std::string::npos)
      << series_refusal(folder.path());
}

TEST(DicomSeries, TwoSeriesInAFolderAreRefusedAndSoIsNone) {
  const TemporaryFolder folder;
  EXPECT_NE(series_refusal(folder.path()).find("no DICOM images"), std::string::npos);
  write_series(folder, {30, 30.7});
  DicomSlice other;
  other.series = "1.2.3.5";
  folder.write("other", dicom(other, counted<std::uint16_t>(6)));
  EXPECT_NE(series_refusal(folder.path()).find("2 DICOM series"), std::string::npos)
      << series_refusal(folder.path());
}

// GDCM with its assertions on ends the program at most of these lengths.
TEST(DicomSeries, AFileThatEndsAnywhereIsRefused) {
  const TemporaryFolder folder;
  const std::string whole = dicom({}, counted<std::uint16_t>(6));
  for (std::size_t length = 1; length < whole.size(); ++length) {
    const auto path = folder.write("slice.dcm", whole.substr(0, length));
    EXPECT_NE(series_refusal(path).find("slice.dcm"), std::string::npos) << length;
    EXPECT_NE(series_refusal(folder.path()).find("DICOM"), std::string::npos) << length;
  }
  folder.write("slice.dcm", whole);
  EXPECT_NE(series_refusal(folder.path()).find("flat image"), std::string::npos);
}

}  // namespace
}  // namespace coapt
