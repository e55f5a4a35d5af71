// What FEBio has that is like our laws, for the registry's entries. Private to this room.
#pragma once

#include "scene/terms/term_types.hpp"

namespace coapt {

std::optional<FebioMaterial> febio_linear(const Parameters& p);
std::optional<FebioMaterial> febio_neo_hookean(const Parameters& p);
std::optional<FebioMaterial> febio_exponential(const Parameters& p);

// Nothing for a cable of constant tension.
std::optional<StressCurve> cable_curve(const Parameters& p);
std::optional<StressCurve> bilinear_curve(const Parameters& p);
std::optional<StressCurve> ogden_curve(const Parameters& p);

}  // namespace coapt
