// What drives the motion of xpbd: the loads of the scene, or flow and pressure after Walczak et al.
#pragma once

#include "energy/objective.hpp"
#include "xpbd/body.hpp"
#include "xpbd/options.hpp"

namespace coapt {

class DrivingForces {
 public:
  // All must outlive it. Throws InputError where the body has not what the options ask for.
  DrivingForces(const Objective& objective, const XpbdBody& body, const XpbdOptions& options);

  // Forces on the nodes at x, 3 x node_count, in the unit of the masses; those of a phase of the heart.
  Points at(const Points& x, HeartPhase phase) const;

 private:
  const Objective& objective_;
  const XpbdBody& body_;
  const XpbdOptions& options_;
  double factor_ = 1;  // from the unit of the forces to that of the masses
};

}  // namespace coapt
