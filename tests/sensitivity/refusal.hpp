// What a call is refused with.
#pragma once

#include "core/error.hpp"

#include <string>

namespace coapt {

// The text of the InputError that it throws.
template <typename Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "nothing was refused";
}

}  // namespace coapt
