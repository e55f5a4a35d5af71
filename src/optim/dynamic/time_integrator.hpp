// One step of the motion of lumped masses, M a + (M/T) v + dE/dq = 0.
#pragma once

#include "linear/factorisation.hpp"
#include "optim/dynamic/dynamic_options.hpp"
#include "optim/monitor.hpp"

#include <memory>

namespace coapt {

// A state of the motion, with all that was evaluated there.
struct Motion {
  Vector q, v;        // unknowns [length] and their velocities [length/time]
  double energy = 0;  // potential [force x length]
  Vector g;           // its gradient [force]
  double time = 0;    // since the start
};

// Twice the kinetic energy is the sum of m v^2. mass: of each unknown.
double kinetic_energy(const Motion& at, const Vector& mass);

class TimeIntegrator {
 public:
  virtual ~TimeIntegrator() = default;

  // Goes on by h. Returns false, with `at` as it was, where no state was found: h is too long. What the terms
  // keep admissible (Monitor::step_limit) stays so.
  virtual bool step(double h, Motion& at) = 0;

  // The step that should follow one of h that led to `at`.
  virtual double next_step(double h, const Motion& at) = 0;

  // Forgets the past: the velocities were changed from outside.
  virtual void restart() {}
};

// mass: of each unknown, > 0. applied: a force that acts besides the objective, constant over a step. All
// must outlive the integrator.
struct TimeIntegratorContext {
  Objective& objective;
  Monitor& monitor;
  const Vector& mass;
  const Vector& applied;
};

// Backward differences of second order for steps of varying length; the first step after a restart is
// implicit Euler's. Each step finds a state near a minimum of E(q) + s/2 |q - q~|^2 in the norm of the masses
// by Newton's method; one iteration keeps the order. L-stable: a long step leads towards the equilibrium.
std::unique_ptr<TimeIntegrator> make_backward_differences(const TimeIntegratorContext& context,
                                                          const DynamicOptions& options,
                                                          const FactorisationFactory& factorisation);

// v += h a(q, v), then q += h v (Hammer et al. 2011: semi-implicit, with adaptive steps). Symplectic without
// drag. Stable up to 2 over the highest angular frequency, of which next_step() keeps a bound (Gershgorin's,
// of the projected Hessian).
std::unique_ptr<TimeIntegrator> make_semi_implicit_euler(const TimeIntegratorContext& context,
                                                         const DynamicOptions& options);

}  // namespace coapt
