// The tissue that a valve JSON states by a formula and its numbers. Private to this room.
//
//   "materials":       {"model": FORMULA, REGION: {"C0": .., "C1": .., "C2": .., "D": ..}, ...}
//   "chord_materials": {"model": FORMULA, SECTION: [mu1, alpha1, mu2, alpha2, ..., D1], ...}
//
// The formula of leaflets is "U = C0/2 (I1-3) + C1/2 (exp(C2 (I1-3)^2) - 1) + (J-1)^2/D", or the same without
// its last part (then without D), and behind commas "isotropic", "incompressible" and the unit of pressure;
// that of chords is "Ogden N=3, MPa: mu1,alpha1,mu2,alpha2,mu3,alpha3" and any remark. Blanks do not matter.
#pragma once

#include "formats/json/read_json.hpp"
#include "formats/valve.hpp"

#include <string>
#include <vector>

namespace coapt::detail {

struct Remarks {
  std::vector<std::string> warnings, defects;  // "materials.septal.C0: missing", without the file
};

// Fills valve.membranes (with the valve's thickness where it has one) and valve.cables, whose laws win where
// both have a name. Regions and sections without a law, laws without a region, and formulas that no term is
// like are warnings; numbers that are missing or cannot be are defects.
void read_stated_laws(const Json& json, Valve& valve, Remarks& remarks);

}  // namespace coapt::detail
