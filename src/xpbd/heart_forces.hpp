// The blood around a valve as simple forces (after Walczak et al. 2019, section 3.4): a flow field and
// pressure, with one sign for each phase of the heart.
#pragma once

#include "xpbd/body.hpp"
#include "xpbd/options.hpp"

namespace coapt {

// Forces per mass on the nodes of the membrane, 3 x node_count, for the weights w and p of systole; diastole
// turns them round. With u the unit axis of the annulus, from the ventricle to the atrium, and m the middle
// of the annulus,
//   f0 = w u             the flow, along the axis
//   f1 = -p n            pressure on the side of the ventricle; n the node's normal, to that side
//   f2 = -p r/|r|        pressure towards the axis; r the node's offset from it
// The paper gives three forces, two weights and the signs; that these are the directions is our reading.
// n points away from the axis, on the average over the surface at rest.
// Pre: has_heart_axis(body).
Points heart_forces(const XpbdBody& body, const Points& x, double w, double p, HeartPhase phase);

// Whether there is an annulus that encloses something, and a membrane.
bool has_heart_axis(const XpbdBody& body);

}  // namespace coapt
