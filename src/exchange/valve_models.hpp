// Published models of a valve's tissue and load, for a valve that has its shape from elsewhere.
#pragma once

#include "exchange/import.hpp"
#include "formats/valve.hpp"

#include <string>
#include <vector>

namespace coapt {

// "hammer-2008", "hammer-2011", "walczak-2019".
std::vector<std::string> valve_model_names();

// Gives the valve the leaflet thickness and the law of every region, and the scene the pressure and the
// modulus of the chords, of a model of edge springs that carry tension only and do not bend:
//   hammer-2008  one bilinear curve, 0.1 and 6 MPa with the knee at 25 %; 1 mm; chords 40 MPa; 13 kPa
//                (Hammer et al. 2008, table 1 and section 2.3.1)
//   hammer-2011  a bilinear curve along the fibre, 0.5 and 6 MPa with the knee at 15 %, and one across, 0.2
//                and 2 MPa with the knee at 25 %; 1 mm; chords 40 MPa; 120 mmHg (after Hammer et al.
//                2011: the kinds of curves, chords that pull only and the pressure are theirs; it states no
//                numbers of the curves, which are those of docs/studies.md, nor thickness and modulus of the
//                chords, which are those of 2008)
// "walczak-2019" leaves the valve as it is: the scene is moved by xpbd with the paper's own masses,
// constraints, flow field and contact (xpbd/options.hpp), and has facet contact, which limits no step, where
// the options name none. Leaflets without regions have the law as a whole. Throws InputError for a model that
// is not known.
void apply_valve_model(const std::string& name, Valve& valve, ImportOptions& options);

}  // namespace coapt
