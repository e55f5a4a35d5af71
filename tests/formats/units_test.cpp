#include "formats/json/units.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace coapt {
namespace {

struct Known {
  const char* text;
  Dimension dimension;
  double value;  // mm, t, s
};

TEST(Units, ConvertsToMillimetreTonneSecond) {
  const Known table[] = {
      {"0.65 mm", kLength, 0.65},
      {"0.65mm", kLength, 0.65},
      {" 3 cm ", kLength, 30},
      {"1.5 m", kLength, 1500},
      {"250 um", kLength, 0.25},
      {"250 µm", kLength, 0.25},
      {"-2e1 mm", kLength, -20},
      {"+2 mm", kLength, 2},
      {"3 cm^2", kArea, 300},
      {"3 cm²", kArea, 300},
      {"3 cm2", kArea, 300},
      {"1 MPa", kPressure, 1},
      {"40 kPa", kPressure, 0.04},
      {"5 Pa", kPressure, 5e-6},
      {"2 GPa", kPressure, 2000},
      {"1 bar", kPressure, 0.1},
      {"120 mmHg", kPressure, 120 * 133.322387415e-6},
      {"1 psi", kPressure, 6894.757293168361e-6},
      {"1 N/mm^2", kPressure, 1},
      {"10 dyn/cm^2", kPressure, 1e-6},
      {"2 N", kForce, 2},
      {"3 mN", kForce, 0.003},
      {"3 kN", kForce, 3000},
      {"1e5 dyn", kForce, 1},
      {"1 kg*m/s^2", kForce, 1},
      {"1 kg m s^-2", kForce, 1},
      {"1000 N/m", kForcePerLength, 1},
      {"0.1 N/mm^3", kForcePerVolume, 0.1},
      {"1 MPa/mm", kForcePerVolume, 1},
      {"1060 kg/m^3", kDensity, 1.06e-9},
      {"1.06 g/cm³", kDensity, 1.06e-9},
      {"9.81 m/s^2", kAcceleration, 9810},
      {"0.05 N*m", kEnergy, 50},
      {"0.05 N·m", kEnergy, 50},
      {"1 J", kEnergy, 1000},
      {"1 mJ", kEnergy, 1},
      {"10 ms", kTime, 0.01},
      {"180 deg", kAngle, 3.14159265358979323846},
      {"45 %", kDimensionless, 0.45},
      {"0.45", kDimensionless, 0.45},
      {"0", kPressure, 0},
  };
  for (const Known& known : table)
    EXPECT_DOUBLE_EQ(quantity_value(known.text, known.dimension), known.value) << known.text;
}

TEST(Units, KeepsTheDoubleNearestToTheDecimalWhereNoFactorIsNeeded) {
  EXPECT_EQ(quantity_value("0.65 mm", kLength), 0.65);
  EXPECT_EQ(quantity_value("0.1 MPa", kPressure), 0.1);
  EXPECT_EQ(quantity_value("0.3 N/mm", kForcePerLength), 0.3);
}

std::string refusal(const char* text, Dimension expected) {
  try {
    const double value = quantity_value(text, expected);
    return "accepted as " + std::to_string(value);
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Units, RefusesWhatIsNoQuantityAndSaysWhy) {
  EXPECT_EQ(refusal("3 kg", kPressure), "read \"3 kg\", a mass; expected a pressure such as \"120 mmHg\"");
  EXPECT_EQ(refusal("3", kLength), "read \"3\", which has no unit; expected a length such as \"0.65 mm\"");
  EXPECT_EQ(refusal("3 mmhg", kPressure), "unknown unit \"mmhg\"; did you mean \"mmHg\"?");
  EXPECT_EQ(
      refusal("3 parsnip", kPressure),
      "unknown unit \"parsnip\"; a pressure has one of Pa, kPa, MPa, GPa, N/mm^2, mmHg, cmH2O, bar, psi");
  EXPECT_EQ(refusal("3 N/inch", kForcePerLength),
            "unknown unit \"inch\"; a force per length has one of N/m, N/mm, mN/mm, dyn/cm");
  EXPECT_NE(refusal("3 parsnip", kDimensionless).find("; known are mm, cm, "), std::string::npos);
  EXPECT_EQ(refusal("3 m^9", kLength).substr(0, 26), "read \"3 m^9\", a quantity i");
  for (const char* text :
       {"nan MPa", "inf MPa", "MPa", "", "-", "1e999 MPa", "1e308 GPa", "--1 MPa", "1 N//mm^2", "1 N/",
        "1 N*", "1 *N/mm^2", "1 N^/mm", "1 N/mm^99", "1,5 MPa", "1 MPa!"})
    EXPECT_EQ(refusal(text, kPressure).find("accepted"), std::string::npos) << text;
}

// What messages name is read.
TEST(Units, KnowsTheUnitsThatItNames) {
  for (const Dimension dimension : {kLength, kArea, kPressure, kForce, kForcePerLength, kForcePerVolume,
                                    kDensity, kAcceleration, kEnergy, kMass, kTime, kAngle}) {
    const std::string text = refusal("1 parsnip", dimension);
    const size_t from = text.find(" one of ");
    ASSERT_NE(from, std::string::npos) << text;
    std::istringstream names(text.substr(from + 8));
    for (std::string name; std::getline(names >> std::ws, name, ',');)
      EXPECT_GT(unit_factor(name, dimension), 0) << name;
  }
}

TEST(Units, GivesTheFactorOfAUnitAlone) {
  EXPECT_EQ(unit_factor("m", kLength), 1000);
  EXPECT_EQ(unit_factor("mm", kLength), 1);
  EXPECT_THROW(unit_factor("Pa", kLength), InputError);
  EXPECT_THROW(unit_factor("furlong", kLength), InputError);
}

}  // namespace
}  // namespace coapt
