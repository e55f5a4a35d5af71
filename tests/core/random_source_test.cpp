#include "core/random_source.hpp"

#include <gtest/gtest.h>

#include <array>

namespace coapt {
namespace {

// By the generator of Steele, Lea and Flood (2014) in integers of any length.
TEST(RandomSourceTest, GivesTheSameNumbersOnEveryPlatform) {
  RandomSource first(0);
  for (const double expected : {0x1.342cc6e8c9d48p-3, 0x1.c4a3d2455e8e8p-1, 0x1.a1f47bd7e7836p-1})
    EXPECT_EQ(first.unit(), expected);
  RandomSource other(42, 7);
  for (const double expected : {0x1.ccb0ee8042ec0p-5, 0x1.e6068081f906ap-2, 0x1.a6ee84a20c9cdp-1})
    EXPECT_EQ(other.unit(), expected);
}

TEST(RandomSourceTest, SpreadsEvenlyOverItsRange) {
  RandomSource random(3);
  std::array<int, 7> count{};
  double sum = 0;
  for (int k = 0; k < 70000; ++k) {
    ++count[static_cast<size_t>(random.below(7))];
    const double number = random.between(-1, 3);
    EXPECT_TRUE(number >= -1 && number < 3);
    sum += number;
  }
  for (const int each : count) EXPECT_NEAR(each, 10000, 400);  // four standard deviations are 370
  EXPECT_NEAR(sum / 70000, 1.0, 0.02);
}

TEST(RandomSourceTest, WholeNumbersReachBothEnds) {
  RandomSource random(4);
  std::array<bool, 3> seen{};
  for (int k = 0; k < 100; ++k) seen[static_cast<size_t>(random.whole(5, 7) - 5)] = true;
  EXPECT_TRUE(seen[0] && seen[1] && seen[2]);
}

TEST(RandomSourceTest, FactorsAreSpreadByTheirLogarithm) {
  RandomSource random(5);
  int below_the_middle = 0;
  for (int k = 0; k < 10000; ++k) {
    const double factor = random.log_between(0.01, 100);
    EXPECT_TRUE(factor >= 0.01 && factor <= 100);
    below_the_middle += factor < 1 ? 1 : 0;
  }
  EXPECT_NEAR(below_the_middle, 5000, 200);  // four standard deviations
}

TEST(RandomSourceTest, StreamsOfOneSeedDiffer) {
  RandomSource first(9, 0), second(9, 1);
  double product = 0;
  for (int k = 0; k < 10000; ++k) product += (first.unit() - 0.5) * (second.unit() - 0.5);
  EXPECT_NEAR(product / 10000, 0.0, 4.0 / 12 / 100);  // four standard deviations of independent numbers
}

}  // namespace
}  // namespace coapt
