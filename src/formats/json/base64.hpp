// Numbers as base64 of little-endian bytes, as scripts of pages read them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace coapt {

std::string base64(std::span<const float> numbers);
std::string base64(std::span<const std::uint32_t> numbers);
std::string base64(std::span<const std::int16_t> numbers);
std::string base64(std::span<const std::int8_t> numbers);

}  // namespace coapt
