#include "core/number_text.hpp"

#include "core/random_source.hpp"
#include "core/types.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace coapt {
namespace {

TEST(NumberText, RoundsToSignificantDigitsWithoutZerosBehind) {
  EXPECT_EQ(number_text(0.125), "0.125");
  EXPECT_EQ(number_text(2.0 / 3.0), "0.667");
  EXPECT_EQ(number_text(2.5, 6), "2.5");
  EXPECT_EQ(number_text(-41.96, 3), "-42");
  EXPECT_EQ(number_text(1.0 / 3.0, 17), "0.33333333333333331");
}

TEST(NumberText, TakesPowersOfTenWherePrintfDoes) {
  EXPECT_EQ(number_text(1e-4), "0.0001");
  EXPECT_EQ(number_text(1.3e-7), "1.3e-07");
  EXPECT_EQ(number_text(999.4), "999");
  EXPECT_EQ(number_text(999.6), "1e+03");
  EXPECT_EQ(number_text(1234.0, 4), "1234");
}

TEST(NumberText, NamesWhatIsNoNumber) {
  EXPECT_EQ(number_text(kInfinity), "inf");
  EXPECT_EQ(number_text(-kInfinity), "-inf");
  EXPECT_EQ(number_text(kNaN), "nan");
  EXPECT_EQ(fixed_text(kNaN, 2), "nan");
  EXPECT_EQ(fixed_text(-kInfinity, 2), "-inf");
}

TEST(NumberText, FixedKeepsItsZerosAndRoundsTiesOfBinaryToEven) {
  EXPECT_EQ(fixed_text(3.0, 2), "3.00");
  EXPECT_EQ(fixed_text(0.125, 2), "0.12");
  EXPECT_EQ(fixed_text(0.375, 2), "0.38");
  EXPECT_EQ(fixed_text(12.7, 0), "13");
}

TEST(NumberText, FixedHoldsItsLongestTextAndGivesUpFromTenToTheFifteenthOn) {
  EXPECT_EQ(fixed_text(-999999999999999.0, 17), "-999999999999999.00000000000000000");
  EXPECT_EQ(fixed_text(1e15, 2), "1e+15");
}

TEST(NumberText, ExactIsShortAndReadsBackToTheSameBits) {
  EXPECT_EQ(exact_text(0.1), "0.1");
  EXPECT_EQ(exact_text(-0.0), "-0");
  EXPECT_EQ(exact_text(1e22), "1e+22");
  EXPECT_EQ(exact_text(std::numeric_limits<double>::denorm_min()), "5e-324");
  RandomSource random(1);
  for (int k = 0; k < 1000; ++k) {
    const double value = std::ldexp(random.between(-1, 1), random.whole(-1000, 1000));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(std::strtod(exact_text(value).c_str(), nullptr)),
              std::bit_cast<std::uint64_t>(value));
  }
}

}  // namespace
}  // namespace coapt
