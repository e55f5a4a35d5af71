#include "fuzz/changed_header.hpp"

#include <gtest/gtest.h>

#include <set>

namespace coapt::fuzz {
namespace {

const std::string kVoxels("\x01\x02\n\n\x00\x05", 6);
const std::string kNrrd = "NRRD0005\ntype: int16\ndimension: 3\nsizes: 2 3 4\n\n" + kVoxels;
const std::string kMetaImage =
    "ObjectType = Image\nNDims = 3\nDimSize = 2 3 4\nElementDataFile = LOCAL\n" + kVoxels;
constexpr std::size_t kSeeds = 1000;

std::string nifti() {
  std::string bytes(352, '\0');
  return bytes.replace(344, 3, "n+1") + kVoxels;
}

std::string dicom() { return std::string(128, '\0') + "DICM" + std::string(40, '\1'); }

TEST(ChangedHeader, LeavesTheVoxelsOfATextAlone) {
  for (const std::string& bytes : {kNrrd, kMetaImage}) {
    std::set<std::string> found;
    for (std::size_t seed = 0; seed < kSeeds; ++seed) {
      const std::string changed = changed_header(bytes, seed);
      ASSERT_GE(changed.size(), kVoxels.size());
      EXPECT_EQ(changed.substr(changed.size() - kVoxels.size()), kVoxels) << changed;
      EXPECT_EQ(changed, changed_header(bytes, seed));
      found.insert(changed);
    }
    EXPECT_GT(found.size(), kSeeds / 4);
  }
}

TEST(ChangedHeader, ReachesEveryKindOfChangeOfALine) {
  int lost = 0, doubled = 0, extreme = 0, other = 0;
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  for (std::size_t seed = 0; seed < kSeeds; ++seed) {
    const std::string changed = changed_header(kNrrd, seed);
    lost += !has(changed, "dimension");
    doubled += has(changed, "sizes: 2 3 4\nsizes: 2 3 4\n");
    extreme += has(changed, "sizes: 2 2147483647 4");
    other += has(changed, "type: 2 3 4");
  }
  for (const int count : {lost, doubled, extreme, other}) EXPECT_GT(count, 0);
}

TEST(ChangedHeader, SetsFieldsOfABinaryHeaderAndKeepsWhatNamesTheFormat) {
  for (const std::string& bytes : {nifti(), dicom()})
    for (std::size_t seed = 0; seed < kSeeds; ++seed) {
      const std::string changed = changed_header(bytes, seed);
      ASSERT_EQ(changed.size(), bytes.size());
      const std::size_t magic = bytes.size() > 300 ? 344 : 128;
      EXPECT_EQ(changed.substr(magic, 3), bytes.substr(magic, 3));
    }
  EXPECT_NE(changed_header(nifti(), 1), nifti());
}

TEST(ChangedHeader, OfAnythingElseIsEmpty) {
  for (const std::string& bytes : {std::string(), std::string("v 0 0 0\n"), std::string(400, 'x')})
    EXPECT_EQ(changed_header(bytes, 3), "");
}

}  // namespace
}  // namespace coapt::fuzz
