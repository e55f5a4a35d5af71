// Laws of tissue from their numbers, whatever file states them, as terms of a scene. Moduli in MPa, lengths
// in mm.
#pragma once

#include "formats/valve.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace coapt::formats {

// Takes what is wrong with a number: "C0 must be positive".
using Refusal = std::function<void(const std::string&)>;

// cst_exponential without its thickness, of
//   U = C0/2 (I1 - 3) + C1/2 (exp(C2 (I1 - 3)^2) - 1) + (J - 1)^2 / D,   so that bulk = 2 / D.
// c0, c1 [MPa], d [1/MPa]; d = 0: incompressible. Nothing where a number is refused.
std::optional<Material> exponential_law(double c0, double c1, double c2, double d, const Refusal& refuse);

// cable_ogden of mu1 [MPa], alpha1, mu2, alpha2 ...: sum of 2 mu/alpha^2 (l1^alpha + l2^alpha + l3^alpha - 3)
// at constant volume. Nothing where the scene has no such law: more than three terms, or one that pushes.
std::optional<Material> ogden_law(const std::vector<double>& pairs);

// "0.001 MPa" and "0.65 mm", in quotes, in the shortest form that reads back to the same bits.
std::string pressure_text(double value);
std::string length_text(double value);

}  // namespace coapt::formats
