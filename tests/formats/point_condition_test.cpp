#include "formats/json/point_condition.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

bool holds(const std::string& text, const Vec3& x) { return PointCondition(text)(x); }

std::string refusal(const std::string& text) {
  try {
    PointCondition condition(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PointCondition, ComparesCoordinatesInMillimetres) {
  EXPECT_TRUE(holds("z > 2", {0, 0, 2.5}));
  EXPECT_FALSE(holds("z > 2", {0, 0, 2}));
  EXPECT_TRUE(holds("z >= 2 mm", {0, 0, 2}));
  EXPECT_TRUE(holds("0.2cm<=z", {0, 0, 2}));
  EXPECT_FALSE(holds("x < 1 um", {0.01, 0, 0}));
  EXPECT_TRUE(holds("x^2 + y^2 < 1 cm^2", {6, 7.9, 0}));
  EXPECT_FALSE(holds("x^2 + y^2 < 1 cm^2", {6, 8.1, 0}));
}

TEST(PointCondition, BindsAsMathematicsDoes) {
  EXPECT_TRUE(holds("1 + 2 * 3 - 8 / 2 / 2 > 4.999 && 1 + 2 * 3 - 8 / 2 / 2 < 5.001", Vec3::Zero()));
  EXPECT_TRUE(holds("-x^2 < 0", {3, 0, 0}));
  EXPECT_TRUE(holds("2 * -x > 5", {-3, 0, 0}));
  EXPECT_TRUE(holds("x > 0 || y > 0 && z > 0", {1, -1, -1}));
  EXPECT_FALSE(holds("(x > 0 || y > 0) && z > 0", {1, -1, -1}));
  EXPECT_TRUE(holds("!(x > 0) && !!(y > 0)", {-1, 1, 0}));
  EXPECT_TRUE(holds("sqrt(x^2 + y^2) > abs(z) && max(x, y) > min(x, z)", {3, 4, -4.5}));
}

TEST(PointCondition, DoesNotHoldForWhatIsNoNumber) {
  EXPECT_FALSE(holds("sqrt(x * y) < 10", {-1, 1, 0}));
  EXPECT_FALSE(holds("x / y > 0 || x / y <= 0", {0, 0, 0}));
}

TEST(PointCondition, NamesTheColumnOfWhatItCannotRead) {
  const std::pair<const char*, const char*> table[] = {
      {"", "column 1: read the end; expected x, y, z"},
      {"z", "column 1: is a number; a condition compares"},
      {"z > ", "column 5: read the end"},
      {"z > 2 &&", "column 9: read the end"},
      {"z > w", "column 5: read \"w\"; expected x, y, z"},
      {"z > 2 kPa", "column 7: \"kPa\" is no unit of length"},
      {"z > 2 x", "column 7: unknown unit \"x\""},
      {"z > 2 mm^2", "column 5: adds to or compares with mm^1 what is in mm^2"},
      {"x * y + z > 2", "column 9: adds to or compares with mm^2 what is in mm^1"},
      {"0 < z < 2", "column 7: read \"< 2\"; expected an operator or the end"},
      {"(0 < z) < 2", "column 1: expected a number; this is a condition"},
      {"z && x > 0", "column 1: expected a comparison"},
      {"x > 0 & y > 0", "column 7: read \"& y > 0\""},
      {"z == 2", "column 3: coordinates are compared by"},
      {"z != 2", "column 3: coordinates are compared by"},
      {"(z > 2", "column 7: read the end; expected \")\""},
      {"min(x) > 2", "column 6: read \") > 2\"; expected \",\""},
      {"sqrt(x) * z > 2", "column 1: takes the root of what is in mm^1"},
      {"x^0.5 > 2", "column 4: read \".5 > 2\""},
      {"x^y > 2", "column 3: read \"y > 2\"; expected a whole exponent"},
      {"x > 1e999", "column 5: read \"1e999\"; expected a number"},
  };
  for (const auto& [text, message] : table)
    EXPECT_NE(refusal(text).find(message), std::string::npos) << text << " -> " << refusal(text);
}

TEST(PointCondition, RefusesWhatIsNestedTooDeeplyOrTooLong) {
  EXPECT_NE(refusal(std::string(3000, '(') + "z").find("nested too deeply"), std::string::npos);
  EXPECT_NE(refusal(std::string(3000, '-') + "z > 0").find("nested too deeply"), std::string::npos);
  EXPECT_NE(refusal("z > 0" + std::string(5000, ' ')).find("too long"), std::string::npos);
}

}  // namespace
}  // namespace coapt
