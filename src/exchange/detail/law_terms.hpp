// The membranes and chords of a valve as terms of a scene, in JSON text. Private to this room.
#pragma once

#include "exchange/import.hpp"
#include "formats/valve.hpp"

#include <string>
#include <vector>

namespace coapt::detail {

// One term for each region and each chord material whose law the valve states; what is left shares the usual
// law of the options.
std::vector<std::string> law_terms(const Valve& valve, const ImportOptions& options);

// The term type of linear leaflets.
std::string linear_membrane_type(const ImportOptions& options);

// A text in quotes.
std::string quoted(const std::string& text);

}  // namespace coapt::detail
