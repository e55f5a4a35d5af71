// What parameters write, so that two of them that would undo each other are found.
#pragma once

#include "energy/term.hpp"

#include <string>
#include <vector>

namespace coapt {

class Parameter;

// A piece of the model that a parameter writes.
struct WrittenDatum {
  enum class Kind {
    Place,      // of a prescribed node, which is the index
    Length,     // rest length of a line
    Shape,      // of an element at rest
    Stiffness,  // multiplied: several parameters may
    Remade,     // all of an element but its length; several may that know of each other
    Made,       // the same by one that knows of no other
    Pressure,   // of the term as a whole
    Force       // of a dead load on a node of the term's stencils
  };
  Kind kind = Kind::Place;
  const EnergyTerm* term = nullptr;  // none: of the nodes
  int index = 0;                     // of the element or node
};

// The same kind for every element of a term.
std::vector<WrittenDatum> whole_term(WrittenDatum::Kind kind, const EnergyTerm& term);

// Why two parameters cannot stand side by side, as a sentence that names both and what they share; empty:
// they can.
std::string clash_of(const Parameter& parameter, const Parameter& other);

// The same of what a parameter writes twice, such as the place of a node that it was given twice.
std::string clash_within(const Parameter& parameter);

}  // namespace coapt
