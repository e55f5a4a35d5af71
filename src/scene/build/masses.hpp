// The masses that a dynamic method moves.
#pragma once

#include "scene/build/model.hpp"

namespace coapt {

// Lumped mass of each node [t]: a third of the rest area times the thickness of each triangle around it and
// half the rest length times the cross-section of each line, times the density [t/mm3]. A node that has next
// to none of these, such as the junction of thin chords, gets a hundredth of the mean, so that it does not
// dictate the time step. Throws InputError where nothing in the model has a mass.
Vector lumped_masses(const Model& model, double density);

}  // namespace coapt
