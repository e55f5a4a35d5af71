// The free edges of the leaflets that an intervention names. Private to this room.
#pragma once

#include "scene/interventions/intervention.hpp"
#include "valve/leaflet_coordinates.hpp"

namespace coapt {

// The free edges of the leaflets that the key `leaflets` or `leaflet` names, or of all regions with one where
// it is absent. All begin at the same commissure: the first of the set "commissures", or where the first free
// edge begins in its loop; two of three or more leaflets where they meet. The set "free_edge" orders them;
// without it, the one boundary loop away from the set "annulus". Throws InputError, naming the entry, where
// these are missing or a region does not reach the free edge.
std::vector<FreeEdge> free_edges(const InterventionSpec& spec, const ValveEdit& edit);

}  // namespace coapt
