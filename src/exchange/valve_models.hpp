// Published models of a valve's tissue and load, for a valve that has its shape from elsewhere.
#pragma once

#include "exchange/import.hpp"
#include "formats/valve.hpp"

#include <string>
#include <vector>

namespace coapt {

// "hammer-2008", "hammer-2011".
std::vector<std::string> valve_model_names();

// Gives the valve the leaflet thickness and the law of every region, and the scene the pressure and the
// modulus of the chords, of a model of edge springs that carry tension only and do not bend:
//   hammer-2008  one bilinear curve, 0.1 and 6 MPa with the knee at 25 %; 1 mm; chords 40 MPa; 16 kPa
//                (Hammer et al. 2008)
//   hammer-2011  a bilinear curve along the fibre, 0.5 and 6 MPa with the knee at 15 %, and one across, 0.2
//                and 2 MPa with the knee at 25 %; 1 mm; chords 40 MPa; 13 kPa (after Hammer et al. 2011:
//                kinds of curves, thickness, chords and pressure are theirs, the numbers of the two curves
//                those of docs/studies.md)
// Pre: the leaflets have regions. Throws InputError for a model that is not known.
void apply_valve_model(const std::string& name, Valve& valve, ImportOptions& options);

}  // namespace coapt
