// Follower pressure: normal to and per area of the deformed surface.
//
// On a closed surface, or one whose rim is fixed, it has the potential -p V and is an ElementTerm of
// FacetVolume. On a surface with a free, moving rim it has none: the term below carries the potential
// of the surface closed by a fan of triangles over the free rims, and the exact remainder as a
// circulatory force. See docs/theory.md, "Follower pressure".
#pragma once

#include "energy/objective.hpp"
#include "energy/term.hpp"

#include <memory>
#include <optional>
#include <string>

namespace coapt {

// Exact consistent nodal forces of the pressure, 3 x node_count [force]: (p/6)(x1-x0)x(x2-x0) to each
// corner. p > 0 pushes along the normals.
Points follower_pressure_forces(const Points& x, const Triangles& triangles, double p);

// Pressure along the normals [force/length^2] of a term that one of the functions below has made, nothing for
// any other; and another one in its place. set_pressure returns whether it is such a term.
std::optional<double> pressure_of(const EnergyTerm& term);
bool set_pressure(EnergyTerm& term, double p);

// The term of model "volume". Throws InputError when the surface has a rim that moves other than
// within a coordinate plane that all such rims can share an origin with: the potential would be wrong.
std::unique_ptr<EnergyTerm> make_volume_pressure(std::string name, const Points& X,
                                                 const Triangles& triangles, double p,
                                                 const FixedMask& fixed);

// The term of model "follower": exact on every surface. On one without a moving rim it is the volume term.
std::unique_ptr<EnergyTerm> make_follower_pressure(std::string name, const Points& X,
                                                   const Triangles& triangles, double p,
                                                   const FixedMask& fixed);

}  // namespace coapt
