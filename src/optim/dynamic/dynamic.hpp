// The motion of masses with drag until it comes to rest.
#pragma once

#include "optim/solver.hpp"

namespace coapt {

// Follows M a + (M/T) v + dE/dq = 0 from the start at rest (DynamicOptions), step by step; each step is an
// accepted iterate, whose energy is that of the whole motion, potential and kinetic. Converged: the residual
// of the objective is below the tolerance and the kinetic energy below the tolerance times force times size.
// Steps that fail are made shorter. Kinetic damping is that of dynamic relaxation (Cundall 1976, Barnes
// 1999). Collisions are no part of the objective: what they hold is out of balance by its residual, and a run
// that has come to rest on them ends as stalled. Of the options: masses, surface, dynamic, factorisation.
// Throws InputError for a mass that is not positive, or an option without meaning.
std::unique_ptr<Solver> make_dynamic(const SolverOptions& options);

// The same by semi-implicit Euler, whatever integration the options name: no linear system is solved. Led
// along no damped path, as the motion has a way of its own.
std::unique_ptr<Solver> make_dynamic_explicit(const SolverOptions& options);

// And with a drag that is the same for all nodes: the mass-spring model of Hammer et al. (2008, eq. 2 and 5;
// 2011, section 2: semi-implicit, with adaptive steps). Throws InputError also where a membrane is no springs
// (SolverOptions::membranes).
std::unique_ptr<Solver> make_mass_spring(const SolverOptions& options);

// Whether the solver of this name moves masses as DynamicOptions say.
bool is_dynamic(std::string_view solver);

}  // namespace coapt
