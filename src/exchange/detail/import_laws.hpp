// What an import makes of the laws and thicknesses that a file states. Private to this room.
#pragma once

#include "exchange/import.hpp"
#include "formats/valve.hpp"

#include <string>
#include <vector>

namespace coapt::detail {

// Other programs' shells are compressed or buckle; ours wrinkle unless the options say that they resist, or
// are springs. A law that a valve JSON states as a term (is_own) stays what it says where the options ask for
// no other.
void take_membrane_option(const ImportOptions& options, bool is_own, Material& law);

// Incompressible membranes. A shell of a program that wrote the file keeps its volume by the program's own
// rule (section Poisson's ratio 0.5 in the published tricuspid valve), whatever the volumetric term of its
// law is.
void leave_bulk_out(const std::string& file, Valve& valve, std::vector<std::string>& warnings);

// The moduli of the options in the place of the valve's laws. A law of another thickness than the valve's
// becomes a linear law of its own.
void take_moduli(const ImportOptions& options, Valve& valve);

// Whether some leaflet resists compression, by the options or by the law that is stated.
bool resists_compression(const ImportOptions& options, const Valve& valve);

// Gives membranes the thickness that the file does not state. True where one, with a law or none, lacked it.
bool complete_thickness(const ImportOptions& options, Valve& valve);

}  // namespace coapt::detail
