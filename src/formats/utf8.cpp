#include "formats/utf8.hpp"

namespace coapt::formats {
namespace {

bool is_utf8(const std::string& bytes) {
  int following = 0;                      // bytes of the character that are still to come
  unsigned char low = 0x80, high = 0xBF;  // of the next one
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (following > 0) {
      if (byte < low || byte > high) return false;
      low = 0x80;
      high = 0xBF;
      --following;
    } else if (byte >= 0x80) {
      if (byte < 0xC2 || byte > 0xF4) return false;
      following = byte < 0xE0 ? 1 : byte < 0xF0 ? 2 : 3;
      if (byte == 0xE0) low = 0xA0;   // shorter forms exist
      if (byte == 0xED) high = 0x9F;  // surrogates
      if (byte == 0xF0) low = 0x90;
      if (byte == 0xF4) high = 0x8F;
    }
  }
  return following == 0;
}

std::string utf8_from_latin1(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      text += c;
    } else {
      text += static_cast<char>(0xC0 | (byte >> 6));
      text += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return text;
}

}  // namespace

std::string as_utf8(std::string bytes) { return is_utf8(bytes) ? std::move(bytes) : utf8_from_latin1(bytes); }

}  // namespace coapt::formats
