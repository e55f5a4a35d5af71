// Numbers in messages. Private to this room.
#pragma once

#include <cstdio>
#include <string>

namespace coapt {

// Three significant digits.
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace coapt
