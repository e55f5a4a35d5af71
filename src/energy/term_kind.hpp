// What a term is made of, for whoever treats some terms in a way of their own. A kernel states it as kKind.
#pragma once

namespace coapt {

enum class TermKind {
  Other,     // none of these, as a term of a program
  Membrane,  // triangles that strain
  Film,      // triangles of constant tension
  Spring,    // mesh edges that stand for a membrane
  Line,      // cables, chords, tethers
  Bending,   // hinges between triangles
  Link,      // pairs of nodes held at a distance
  Pressure,  // on a surface; also as it acts on the reference shape
  DeadLoad,  // nodal forces
  Contact
};

}  // namespace coapt
