// Numbers of fixed width in binary files of either byte order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace coapt::formats {

enum class Scalar { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float32, Float64 };

inline size_t byte_count(Scalar type) {
  static constexpr size_t kBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kBytes[static_cast<size_t>(type)];
}

// Pre: `bytes` holds the number; `swap` when the file's byte order is not the machine's.
template <class Number>
Number load(const char* bytes, bool swap) {
  char buffer[sizeof(Number)];
  std::memcpy(buffer, bytes, sizeof(Number));
  if (swap) std::reverse(buffer, buffer + sizeof(Number));
  Number value;
  std::memcpy(&value, buffer, sizeof(Number));
  return value;
}

template <class Number>
Number load_as(Scalar type, const char* bytes, bool swap) {
  switch (type) {
    case Scalar::Int8:
      return static_cast<Number>(load<std::int8_t>(bytes, swap));
    case Scalar::UInt8:
      return static_cast<Number>(load<std::uint8_t>(bytes, swap));
    case Scalar::Int16:
      return static_cast<Number>(load<std::int16_t>(bytes, swap));
    case Scalar::UInt16:
      return static_cast<Number>(load<std::uint16_t>(bytes, swap));
    case Scalar::Int32:
      return static_cast<Number>(load<std::int32_t>(bytes, swap));
    case Scalar::UInt32:
      return static_cast<Number>(load<std::uint32_t>(bytes, swap));
    case Scalar::Int64:
      return static_cast<Number>(load<std::int64_t>(bytes, swap));
    case Scalar::UInt64:
      return static_cast<Number>(load<std::uint64_t>(bytes, swap));
    case Scalar::Float32:
      return static_cast<Number>(load<float>(bytes, swap));
    case Scalar::Float64:
      return static_cast<Number>(load<double>(bytes, swap));
  }
  return Number{};
}

// Appends a number in the machine's byte order.
template <class Number>
void store(std::string& bytes, Number value) {
  char buffer[sizeof(Number)];
  std::memcpy(buffer, &value, sizeof(Number));
  bytes.append(buffer, sizeof(Number));
}

inline constexpr bool kLittleEndian = std::endian::native == std::endian::little;

}  // namespace coapt::formats
