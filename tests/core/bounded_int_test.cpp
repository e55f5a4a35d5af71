#include "core/bounded_int.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace coapt {
namespace {

TEST(BoundedInt, TakesTheFractionAway) {
  EXPECT_EQ(bounded_int(2.9, 0, 10), 2);
  EXPECT_EQ(bounded_int(-2.9, -10, 10), -2);
}

TEST(BoundedInt, KeepsToItsBoundsWhateverTheNumber) {
  constexpr double kLarge = 1e300, kInfinite = std::numeric_limits<double>::infinity();
  for (const double large : {11.0, 3e9, kLarge, kInfinite}) {
    EXPECT_EQ(bounded_int(large, -3, 10), 10);
    EXPECT_EQ(bounded_int(-large, -3, 10), -3);
  }
  EXPECT_EQ(bounded_int(std::numeric_limits<double>::quiet_NaN(), -3, 10), -3);
}

}  // namespace
}  // namespace coapt
