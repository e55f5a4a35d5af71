// Terms of cables and tethers: the chords of a network, or edges of the mesh. Private to this room.
#pragma once

#include "scene/terms/term_types.hpp"

namespace coapt {

// Each notes its lines in the model, and leaves out those of no length with a warning. Throws InputError
// where no line is left or one has no cross-section.
TermPointer build_cable(const TermSpec& spec, BuildContext& context);
TermPointer build_cable_bilinear(const TermSpec& spec, BuildContext& context);
TermPointer build_cable_ogden(const TermSpec& spec, BuildContext& context);
TermPointer build_cable_toe(const TermSpec& spec, BuildContext& context);
TermPointer build_cable_crimped_fibre(const TermSpec& spec, BuildContext& context);
TermPointer build_tether(const TermSpec& spec, BuildContext& context);

}  // namespace coapt
