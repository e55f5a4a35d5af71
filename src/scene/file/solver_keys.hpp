// The key `solver` of a scene, with what each method may be told.
#pragma once

#include "scene/file/schema.hpp"

namespace coapt {

KeySpec solver_key();

}  // namespace coapt
