// Results that cannot be written.
#pragma once

#include "core/error.hpp"

namespace coapt {

// What was computed cannot be written: a full disk, a folder that went away. The input is as good as it was.
class OutputError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace coapt
