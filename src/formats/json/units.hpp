// Quantities as text: "120 mmHg", "0.65 mm", "1000 N/m", "9.81 m/s^2", "1060 kg/m^3".
// Inside, everything is in one consistent system: mm, t (tonne), s, hence N, MPa = N/mm^2, mJ = N mm.
#pragma once

#include <string>
#include <string_view>

namespace coapt {

// Powers of the base quantities.
struct Dimension {
  int length = 0, mass = 0, time = 0, angle = 0;
  bool operator==(const Dimension&) const = default;
};

inline constexpr Dimension kDimensionless{0, 0, 0, 0};
inline constexpr Dimension kLength{1, 0, 0, 0};
inline constexpr Dimension kArea{2, 0, 0, 0};
inline constexpr Dimension kPressure{-1, 1, -2, 0};  // also a modulus
inline constexpr Dimension kForce{1, 1, -2, 0};
inline constexpr Dimension kForcePerLength{0, 1, -2, 0};   // tension of a film, stress resultant
inline constexpr Dimension kForcePerVolume{-2, 1, -2, 0};  // strength of the facet contact
inline constexpr Dimension kDensity{-3, 1, 0, 0};
inline constexpr Dimension kAcceleration{1, 0, -2, 0};
inline constexpr Dimension kEnergy{2, 1, -2, 0};
inline constexpr Dimension kMass{0, 1, 0, 0};
inline constexpr Dimension kTime{0, 0, 1, 0};
inline constexpr Dimension kAngle{0, 0, 0, 1};

struct Quantity {
  double value = 0;  // in the internal system
  Dimension dimension;
};

// A finite number followed by a unit: products ("N*m", "N m"), quotients ("kg/m^3") and integer powers
// ("m^2", "m2", "m²") of symbols with SI prefixes. A number alone is dimensionless.
// Throws InputError saying what was read and why it cannot be.
Quantity parse_quantity(std::string_view text);

// The value of `text` in the internal unit of `expected`; zero needs no unit. Throws InputError where the
// unit is missing, unknown or of another dimension, saying what was read and what is expected.
double quantity_value(std::string_view text, Dimension expected);

// The factor that turns numbers in `unit` ("m", "cm") into the internal unit of `expected`.
double unit_factor(std::string_view unit, Dimension expected);

// For messages and pages: "pressure", its internal unit "MPa", a quantity as one writes it "120 mmHg".
// A dimension without a name is written as powers of mm, t, s.
std::string dimension_name(Dimension dimension);
std::string internal_unit(Dimension dimension);
std::string dimension_example(Dimension dimension);

}  // namespace coapt
