// A length as an argument of the command.
#pragma once

#include "core/error.hpp"
#include "formats/json/units.hpp"

#include <string>

namespace coapt::cli {

// "0.5mm" in mm. Throws InputError naming the option.
inline double length_argument(const std::string& option, const std::string& text) {
  try {
    return quantity_value(text, kLength);
  } catch (const InputError& error) {
    throw error.within(option);
  }
}

}  // namespace coapt::cli
