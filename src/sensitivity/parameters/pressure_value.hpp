// The pressure of a load term as a parameter.
#pragma once

#include "sensitivity/parameters/parameter.hpp"

#include <memory>

namespace coapt {

// One number: the pressure of a follower or volume pressure term along its normals [MPa]; the sign stays.
// sign: 1, or -1 for the pressure against them, as a scene gives it on the front. Contact keeps the stiffness
// that it was built with. Throws InputError for any other term, and for one
// without pressure.
std::unique_ptr<Parameter> make_pressure_value(std::string name, EnergyTerm& term, double sign = 1);

}  // namespace coapt
