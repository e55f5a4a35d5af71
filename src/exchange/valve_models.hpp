// Published models of a valve's tissue and load, for a valve that has its shape from elsewhere.
#pragma once

#include "exchange/import.hpp"
#include "formats/valve.hpp"

#include <string>
#include <vector>

namespace coapt {

// "hammer-2008", "hammer-2011", "burlina-2010", "toma-2016", "walczak-2019".
std::vector<std::string> valve_model_names();

// Gives the valve the laws, and the scene the loads, contact, held nodes and solver, of a published model;
// sets options.notes, the README.md beside the scene: what the paper states, where it is not followed, what
// it leaves open and what was chosen.
//   hammer-2008   springs that pull only, one bilinear curve; chords 40 MPa; 13 kPa. Table 1.
//   hammer-2011   springs, one curve along the fibre and one across; 120 mmHg. Section 2, which prints no
//                 numbers of the curves.
//   burlina-2010  forces toward the commissure line, a linear membrane that resists compression, cubic
//                 tethers of the free rim, facets that repel each other, nodes beyond the annulus' plane
//                 held. Section 3, which prints no numbers.
//   toma-2016     crimped fibres in a soft matrix, annulus and tips held; 120 mmHg. Section 2.5: one
//                 population of fibres, no active stress, no failure.
//   walczak-2019  the valve as it is, moved by xpbd with the paper's own masses, constraints, flow field and
//                 contact (xpbd/options.hpp); facet contact, which limits no step, where no other is asked
//                 for.
// Throws InputError for a model that is not known, and with all that the model needs and the valve has not:
// regions, annulus, commissures, chords.
void apply_valve_model(const std::string& name, Valve& valve, ImportOptions& options);

}  // namespace coapt
