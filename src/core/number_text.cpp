#include "core/number_text.hpp"

#include <charconv>
#include <cmath>

namespace coapt {

std::string number_text(double value, int digits) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr};
}

std::string fixed_text(double value, int decimals) {
  if (!(std::abs(value) < 1e15)) return number_text(value);
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, decimals).ptr};
}

std::string exact_text(double value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace coapt
