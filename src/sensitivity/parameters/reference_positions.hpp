// Where nodes are in the stress-free shape of the membrane, as a parameter.
#pragma once

#include "energy/objective.hpp"
#include "sensitivity/parameters/parameter.hpp"

#include <memory>
#include <vector>

namespace coapt {

// The coordinates of `nodes` in the rest shape X (3 x node_count), node after node [length]. They change the
// rest shape of membranes of constant-strain triangles (of any law, with their thickness) and of hinges (with
// their plate stiffness). A fibre is a line drawn on its triangle and goes with the corners, whatever the
// scene took its direction from. Rest lengths of chords are data of their own and stay, and so do dead loads,
// terms of the program's own, and the weights and ranges of contact, which belong to the mesh as it was
// built. Derivatives are analytic for membranes; for hinges they are central differences of fourth order of
// their exact forces with steps of 3e-4 of the edge: a truncation of some 1e-14 and a rounding of some 1e-12,
// against an agreement of 1e-6 that the tests ask for. Throws InputError, all defects in one pass: a node out
// of range, a term of springs, which know nothing of the triangles that they stand for, X that is not the
// rest shape of the terms. value() of a shape in which a triangle has no area is a defect.
std::unique_ptr<Parameter> make_reference_positions(std::string name, const Objective& objective, Points X,
                                                    std::vector<int> nodes);

}  // namespace coapt
