// The blood around a valve as simple forces (Walczak et al. 2019, section 3.6): a flow field and pressure,
// with one sign for each phase of the heart.
#pragma once

#include "xpbd/body.hpp"
#include "xpbd/options.hpp"

namespace coapt {

// Forces per mass on the nodes of the membrane, 3 x node_count, for the weights of systole; diastole turns
// them round. With u the unit axis of the annulus, from the ventricle to the atrium, n the node's normal
// towards the axis (on the average over the surface at rest) and w, p, r the weights `flow`, `pressure`,
// `radial` of the paper's numbers,
//   f0 = w u             the flow, along the axis (eq. 16, 18)
//   f1 = (w u . n) n     the flow that meets the surface (eq. 17)
//   f2 = p n             pressure (eq. 19)
//   -r o/|o|             ours: towards the axis; o the node's offset from it
// The paper's normal of the annulus plane points to the tips and w has both signs; flow to the atrium in
// systole is our reading of that.
// Pre: has_heart_axis(body).
Points heart_forces(const XpbdBody& body, const Points& x, const XpbdPaper& weights, HeartPhase phase);

// Whether there is an annulus that encloses something, and a membrane.
bool has_heart_axis(const XpbdBody& body);

}  // namespace coapt
