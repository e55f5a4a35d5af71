// The response of a shape to its parameters, as the sliders of a page read it. Private to this room.
#pragma once

#include "formats/json/json_text.hpp"
#include "results/first_order.hpp"

namespace coapt {

// Displacements are rounded to steps of two bytes, or of one where two would take more than their room, and
// of as many parameters as there is room for. The errors that are told include the rounding.
OrderedJson sliders_json(const FirstOrder& first_order);

}  // namespace coapt
