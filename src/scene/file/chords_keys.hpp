// The key `chords` of a scene: chords that are made when it is built.
#pragma once

#include "scene/file/schema.hpp"

namespace coapt {

KeySpec chords_key();

}  // namespace coapt
