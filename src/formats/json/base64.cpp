#include "formats/json/base64.hpp"

#include <bit>
#include <type_traits>

namespace coapt {
namespace {

constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string coded(const std::string& bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t three = 0;
    for (size_t j = 0; j < 3; ++j)
      three = (three << 8) | (k + j < bytes.size() ? static_cast<unsigned char>(bytes[k + j]) : 0u);
    for (size_t j = 0; j < 4; ++j)
      text += k + j <= bytes.size() ? kLetters[(three >> (18 - 6 * j)) & 63] : '=';
  }
  return text;
}

template <class Number>
std::string little_endian(std::span<const Number> numbers) {
  std::string bytes;
  bytes.reserve(sizeof(Number) * numbers.size());
  for (const Number number : numbers) {
    std::uint32_t word = 0;
    if constexpr (sizeof(Number) == sizeof word)
      word = std::bit_cast<std::uint32_t>(number);
    else
      word = static_cast<std::make_unsigned_t<Number>>(number);
    for (unsigned shift = 0; shift < 8 * sizeof(Number); shift += 8)
      bytes += static_cast<char>((word >> shift) & 255);
  }
  return bytes;
}

}  // namespace

std::string base64(std::span<const float> numbers) { return coded(little_endian(numbers)); }
std::string base64(std::span<const std::uint32_t> numbers) { return coded(little_endian(numbers)); }
std::string base64(std::span<const std::int16_t> numbers) { return coded(little_endian(numbers)); }
std::string base64(std::span<const std::int8_t> numbers) { return coded(little_endian(numbers)); }

}  // namespace coapt
