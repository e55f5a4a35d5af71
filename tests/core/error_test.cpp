#include "core/error.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

TEST(InputErrorTest, CarriesEveryDefectAndSaysThemInLines) {
  const InputError error(std::vector<std::string>{"nu: is 0.6; at most 0.5", "mesh: no such file"});
  EXPECT_STREQ(error.what(), "nu: is 0.6; at most 0.5\nmesh: no such file");
  EXPECT_EQ(error.defects().size(), 2U);
}

TEST(InputErrorTest, OneDefectIsTheWholeMessage) {
  const InputError error("mesh: no such file");
  EXPECT_STREQ(error.what(), "mesh: no such file");
  EXPECT_EQ(error.defects(), std::vector<std::string>{"mesh: no such file"});
}

TEST(InputErrorTest, IsPlacedDefectByDefect) {
  const InputError placed =
      InputError(std::vector<std::string>{"a", "b"}).within("scene.json").within("folder");
  EXPECT_EQ(placed.defects(), (std::vector<std::string>{"folder: scene.json: a", "folder: scene.json: b"}));
  EXPECT_STREQ(placed.what(), "folder: scene.json: a\nfolder: scene.json: b");
}

}  // namespace
}  // namespace coapt
