#include "core/components.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

namespace coapt {
namespace {

TEST(Components, EachHasItsNameLicenceAndUse) {
  const std::vector<Component> all = components();
  ASSERT_FALSE(all.empty());
  for (const Component& each : all) {
    EXPECT_FALSE(each.name.empty());
    EXPECT_FALSE(each.licence.empty()) << each.name;
    EXPECT_FALSE(each.gives.empty()) << each.name;
  }
}

TEST(Components, TheWholeIsUnderTheGplWhereAPartIs) {
  const std::vector<Component> all = components();
  const bool has_gpl = std::ranges::any_of(
      all, [](const Component& each) { return each.present && each.licence.starts_with("GPL"); });
  EXPECT_EQ(combined_licence().starts_with("GPL"), has_gpl) << combined_licence();
}

TEST(Components, TheVersionHasThreeNumbers) {
  EXPECT_TRUE(std::regex_match(version(), std::regex(R"(\d+\.\d+\.\d+)"))) << version();
}

}  // namespace
}  // namespace coapt
