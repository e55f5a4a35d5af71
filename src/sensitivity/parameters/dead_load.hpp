// Dead loads as a parameter: nodal forces of fixed direction, gravity and frozen pressure among them.
#pragma once

#include "sensitivity/parameters/parameter.hpp"

#include <memory>

namespace coapt {

// Whether the term is one of dead loads that loads a node.
bool is_dead_load(EnergyTerm& term);

// One factor on all forces as they are when it is made, first 1; any finite number. The forces are linear in
// whatever they were made from (a traction, a density, an acceleration): the derivative by that is this one
// over its value.
std::unique_ptr<Parameter> make_load_factor(std::string name, EnergyTerm& term);

// The force on each loaded node by itself, x, y, z node after node in the order of term.stencils() [force].
// Nodes that have none when the term is built are not among them.
std::unique_ptr<Parameter> make_nodal_forces(std::string name, EnergyTerm& term);

// Both are exact: the energy is linear in the forces and in the positions. Both throw InputError for a term
// that is no dead load, or that loads no node; the term must outlive the parameter.

}  // namespace coapt
