// How the motion of masses is followed until it comes to rest.
#pragma once

namespace coapt {

enum class TimeIntegration {
  BackwardDifferences,  // of second order, implicit (Hammer et al. 2008, eq. 3-5)
  SemiImplicitEuler     // of first order, explicit but for the order in which it takes velocity and position
};

// What keeps sheets apart besides the contact terms of the objective (VertexProximity).
enum class Collisions {
  None,
  Inelastic,  // vertices that are near a facet do not approach it (Hammer et al. 2008)
  Balanced    // nor does a force press them towards it (Hammer et al. 2011)
};

// What slows masses down, with the relaxation time T.
enum class Drag {
  ByMass,  // (M/T) v: all masses alike
  Equal    // b v with the mean mass over T for b (Hammer et al. 2008, eq. 5: -b I); of semi-implicit Euler
};

struct DynamicOptions {
  TimeIntegration integration = TimeIntegration::BackwardDifferences;
  double time_step = 1e-4;   // the first; the only one unless steps adapt [s]
  bool adapts_steps = true;  // backward differences: to the work of a step; Euler: to the highest frequency
  double longest_step = 1;   // [s]; far beyond any oscillation, and an animation keeps a time axis
  double relaxation_time = 1e-3;  // in which drag alone slows a mass down by a factor e [s]; 0: no drag
  Drag drag = Drag::ByMass;
  bool has_kinetic_damping = false;       // masses stand still whenever the kinetic energy has begun to fall
  bool uses_conjugate_gradients = false;  // backward differences: instead of a factorisation
  Collisions collisions = Collisions::None;
  double collision_distance = 0;  // at which they act, > 0 [length]
};

}  // namespace coapt
