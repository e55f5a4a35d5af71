// Valves as `coapt phantom` images them: with their chords, between walls.
#pragma once

#include "formats/valve.hpp"
#include "image/phantom.hpp"

namespace coapt::testing {

Volume image_with_chords(const Valve& valve, const coapt::PhantomOptions& options);

// Voxels of 0.5 mm, without gaps.
coapt::PhantomOptions clear_phantom(unsigned seed);

}  // namespace coapt::testing
