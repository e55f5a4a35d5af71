// The logarithms of a tuned scene's factors as parameters of an equilibrium. Private to this room.
#pragma once

#include "sensitivity/tuning.hpp"
#include "tuning/tuned_scene.hpp"

namespace coapt {

// Equilibria of a model that was built from tuned.scene(ones), one parameter for each factor, which begins at
// 0. All must outlive what is returned. docs/studies.md says what a factor is on; bending that takes its
// stiffness from a membrane follows.
EquilibriumMaker region_factor_maker(const TunedScene& tuned, Model& model, const TrackingOptions& tracking);

}  // namespace coapt
