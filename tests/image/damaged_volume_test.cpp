// MetaImage and DICOM files after an accident: what comes of each is a volume or one clear sentence, in time.
#include "core/error.hpp"
#include "core/random_source.hpp"
#include "image/detail/trial_process.hpp"
#include "image/hand_made_files.hpp"
#include "image/read_volume.hpp"
#include "image/write_volume.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <functional>

namespace coapt {
namespace {

constexpr double kLongestRead = 20;  // [s], of one file on a crowded machine

// Empty where the volume was read.
std::string refusal_in_time(const std::filesystem::path& path) {
  const auto start = std::chrono::steady_clock::now();
  std::string text;
  try {
    const VolumeFile file = read_volume(path);
    EXPECT_EQ(file.volume.values.size(), static_cast<std::size_t>(file.volume.size[0]) *
                                             static_cast<std::size_t>(file.volume.size[1]) *
                                             static_cast<std::size_t>(file.volume.size[2]));
  } catch (const InputError& error) {
    text = error.what();
    EXPECT_EQ(error.defects().size(), 1u) << text;
    EXPECT_NE(text.find(path.filename().string()), std::string::npos) << text;
    EXPECT_EQ(std::count_if(text.begin(), text.end(), [](unsigned char c) { return c < ' ' && c != '\t'; }),
              0)
        << text;
  }
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), kLongestRead);
  return text;
}

void expect_refused(const std::filesystem::path& path, const std::string& reason, const std::string& remedy) {
  const std::string text = refusal_in_time(path);
  EXPECT_NE(text.find(reason), std::string::npos) << text << " instead of " << reason;
  EXPECT_NE(text.find(remedy), std::string::npos) << text << " instead of " << remedy;
}

// One to three bytes changed, cut out, or put in.
std::string changed(std::string bytes, RandomSource& random, std::size_t first, std::size_t last) {
  const auto below = [&](std::size_t bound) {
    return std::min(bound - 1, static_cast<std::size_t>(random.unit() * static_cast<double>(bound)));
  };
  for (std::size_t times = 1 + below(3); times > 0; --times) {
    const std::size_t place = std::min(first + below(last - first), bytes.size() - 1);
    const char byte = static_cast<char>(below(256));
    if (const std::size_t what = below(4); what < 2) {
      bytes[place] = byte;
    } else if (what == 2) {
      bytes.erase(place, 1 + below(8));
    } else {
      bytes.insert(place, 1 + below(8), byte);
    }
  }
  return bytes;
}

const std::string kMetaFields =
    "NDims = 3\nDimSize = 2 3 4\nElementType = MET_SHORT\nElementSpacing = 0.5 0.6 0.7\n"
    "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 10 20 30\n";

TEST(DamagedMetaImage, EachDefectOfAHeaderIsNamed) {
  const TemporaryFolder folder;
  const auto expect = [&](const std::string& from, const std::string& to, const std::string& reason) {
    std::string bytes = meta_image(kMetaFields, counted<std::int16_t>(24));
    ASSERT_EQ(refusal_in_time(folder.write("v.mha", bytes)), "");
    const std::size_t at = bytes.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    expect_refused(folder.write("v.mha", bytes.replace(at, from.size(), to)), reason, "");
  };
  expect("NDims = 3", "NDims = x", "NDims: 'x' is not a number");
  expect("NDims = 3", "NDims = 99", "not a whole number from 1 to 10");
  expect("NDims = 3", "NDims = 4", "wants 4 numbers");
  expect("NDims = 3\n", "", "NDims is missing");
  expect("NDims = 3\n", "NDims = 3\nNDims = 3\n", "line 6 says 'ndims' once more");
  expect("DimSize = 2 3 4", "DimSize = 2 3", "DimSize wants 3 numbers");
  expect("DimSize = 2 3 4", "DimSize = 2 3 -4", "whole positive numbers");
  expect("DimSize = 2 3 4", "DimSize = 2 3 5", "48 bytes of voxels instead of 60");
  expect("MET_SHORT", "MET_SHRT", "ElementType is 'MET_SHRT'");
  expect("0.5 0.6 0.7", "0.5 0.6 0.7x", "'0.7x' is not a number");
  expect("0.5 0.6 0.7", "0.5 0.6 1e999", "too large");
  expect("= 10 20 30", "= 10 20", "Offset wants 3 numbers");
  expect("= 0 1 0 -1", "= 0 1 nan -1", "TransformMatrix: 'nan' is not a finite number");
  expect("NDims = 3", "NDims 3", "line 5 is no `key = value` but 'NDims 3'");
  expect("= LOCAL", "= LIST", "one file alone");
  expect("= LOCAL", "= slice%03d.raw 1 4 1", "one file alone");
  expect("= LOCAL", "= none.raw", "none.raw");
  expect("CompressedData = False", "CompressedData = True", "are damaged");
  expect("ObjectType = Image", "ObjectType = Tube", "ObjectType is 'Tube'");
}

TEST(DamagedMetaImage, VoxelsAreReadPackedAsTextTurnedAndFromAnotherFile) {
  const TemporaryFolder folder;
  const auto expect_voxels = [&](const std::filesystem::path& path) {
    const Volume volume = read_volume(path).volume;
    ASSERT_EQ(volume.values.size(), 24u);
    for (std::size_t k = 0; k < 24; ++k) EXPECT_EQ(volume.values[k], static_cast<float>(k));
  };
  std::string text, turned, head = "BinaryData = True\nCompressedData = False\n";
  for (int k = 0; k < 24; ++k) {
    text += std::to_string(k) + "\n";
    turned += std::string{'\0', static_cast<char>(k)};
  }
  expect_voxels(
      folder.write("v.mha", "BinaryData = False\n" + kMetaFields + "ElementDataFile = LOCAL\n" + text));
  expect_refused(folder.write("v.mha", "BinaryData = False\n" + kMetaFields + "ElementDataFile = LOCAL\n" +
                                           text.substr(0, text.size() - 4)),
                 "23 numbers instead of 24", "again");
  expect_voxels(folder.write("v.mha", head + "BinaryDataByteOrderMSB = True\n" + kMetaFields +
                                          "ElementDataFile = LOCAL\n" + turned));
  folder.write("v.raw", "seven b" + counted<std::int16_t>(24));
  for (const char* skipped : {"7", "-1"})
    expect_voxels(folder.write(
        "v.mhd", head + kMetaFields + "HeaderSize = " + skipped + "\nElementDataFile = v.raw\n"));
  Volume volume;
  volume.size = {2, 3, 4};
  for (int k = 0; k < 24; ++k) volume.values.push_back(static_cast<float>(k));
  write_volume(folder.path() / "w.mha", volume, VoxelKind::Int16);
  const std::string packed = text_of(folder.path() / "w.mha");
  ASSERT_NE(packed.find("CompressedData = True"), std::string::npos);
  expect_voxels(folder.path() / "w.mha");
  for (std::size_t cut = 12; cut < 30; ++cut)
    expect_refused(folder.write("x.mha", packed.substr(0, packed.size() - cut)), "", "again");
  std::string wrong = packed;
  wrong.back() = static_cast<char>(wrong.back() ^ 1);  // of the checksum
  expect_refused(folder.write("x.mha", wrong), "are damaged", "again");
}

TEST(DamagedMetaImage, SeveralHundredAccidentsEndInAVolumeOrASentence) {
  const TemporaryFolder folder;
  RandomSource random(7);
  const std::string whole = meta_image(kMetaFields, counted<std::int16_t>(24));
  int read = 0, refused = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const auto path = folder.write("v.mha", changed(whole, random, 0, whole.size() - 40));
    ++(refusal_in_time(path).empty() ? read : refused);
  }
  EXPECT_GT(read, 20);
  EXPECT_GT(refused, 200);
  for (std::size_t length = 1; length < whole.size(); ++length)
    EXPECT_NE(refusal_in_time(folder.write("v.mha", whole.substr(0, length))), "") << length;
}

TEST(DamagedDicom, AccidentsEndInAVolumeOrASentence) {
  const TemporaryFolder folder;
  RandomSource random(11);
  DicomSlice upper;
  upper.number = 2;
  upper.position = "0\\0\\0.7";
  folder.write("upper", dicom(upper, counted<std::uint16_t>(6)));
  const std::string whole = dicom({}, counted<std::uint16_t>(6));
  folder.write("lower", whole);
  EXPECT_EQ(read_volume(folder.path()).volume.size, (std::array{2, 3, 2}));
  int read = 0, refused = 0;
  for (int trial = 0; trial < 120; ++trial) {
    folder.write("lower", changed(whole, random, 132, whole.size()));
    try {
      read_volume(folder.path());
      ++read;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(folder.path().string()), std::string::npos) << error.what();
      ++refused;
    }
  }
  EXPECT_GT(read, 5);
  EXPECT_GT(refused, 20);
}

// GDCM guesses their length from other bytes, and asks for gigabytes.
TEST(DamagedDicom, PixelsOfNoKindAreRefused) {
  const TemporaryFolder folder;
  std::string bytes = dicom({}, counted<std::uint16_t>(6));
  const std::size_t pixels = bytes.find(std::string("\xe0\x7f\x10\0OW", 6));
  ASSERT_NE(pixels, std::string::npos);
  bytes[pixels + 5] = '\0';
  expect_refused(folder.write("v.dcm", bytes), "what kind of numbers its pixels are", "export it again");
}

TEST(TrialProcess, SaysWhatEndedIt) {
  const TrialLimits limits{1, std::uintmax_t(1) << 28};
  EXPECT_EQ(end_of_trial([] {}, limits), "");
  EXPECT_EQ(end_of_trial([] { throw InputError("no"); }, limits), "");
  EXPECT_EQ(end_of_trial([] { std::abort(); }, limits), "an assertion");
  EXPECT_EQ(end_of_trial([] { throw 1; }, limits), "an exception");
  const auto for_ever = [] {
    std::atomic<int> count = 0;
    while (count >= 0) count = (count + 1) % 1000;
  };
  EXPECT_EQ(end_of_trial(for_ever, limits), "more than 1 s");
  const auto much = [] {
    std::vector<std::vector<char>> memory;
    for (int k = 0; k < 64; ++k) memory.emplace_back(1 << 24, 'a');
  };
  EXPECT_NE(end_of_trial(much, limits), "");
}

}  // namespace
}  // namespace coapt
