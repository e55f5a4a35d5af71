#include "image/voxel_kind.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace coapt {
namespace {

constexpr std::array<std::pair<VoxelKind, const char*>, 10> kVoxelKindNames{
    {{VoxelKind::UInt8, "uint8"},
     {VoxelKind::Int8, "int8"},
     {VoxelKind::UInt16, "uint16"},
     {VoxelKind::Int16, "int16"},
     {VoxelKind::UInt32, "uint32"},
     {VoxelKind::Int32, "int32"},
     {VoxelKind::UInt64, "uint64"},
     {VoxelKind::Int64, "int64"},
     {VoxelKind::Float32, "float32"},
     {VoxelKind::Float64, "float64"}}};

// Calls visit with a number of the kind's type.
template <typename Visit>
auto with_type(VoxelKind kind, const Visit& visit) {
  switch (kind) {
    case VoxelKind::UInt8:
      return visit(std::uint8_t{});
    case VoxelKind::Int8:
      return visit(std::int8_t{});
    case VoxelKind::UInt16:
      return visit(std::uint16_t{});
    case VoxelKind::Int16:
      return visit(std::int16_t{});
    case VoxelKind::UInt32:
      return visit(std::uint32_t{});
    case VoxelKind::Int32:
      return visit(std::int32_t{});
    case VoxelKind::UInt64:
      return visit(std::uint64_t{});
    case VoxelKind::Int64:
      return visit(std::int64_t{});
    case VoxelKind::Float32:
      return visit(float{});
    case VoxelKind::Float64:
      break;
  }
  return visit(double{});
}

template <typename Number>
Number nearest(float value) {
  if constexpr (std::is_floating_point_v<Number>) {
    return static_cast<Number>(value);
  } else {
    const double rounded = std::nearbyint(static_cast<double>(value));
    // The limits of 64 bits are rounded up as doubles, and what is not below one is the limit itself.
    if (rounded >= static_cast<double>(std::numeric_limits<Number>::max()))
      return std::numeric_limits<Number>::max();
    if (rounded <= static_cast<double>(std::numeric_limits<Number>::min()))
      return std::numeric_limits<Number>::min();
    return static_cast<Number>(rounded);
  }
}

}  // namespace

std::string voxel_kind_name(VoxelKind kind) { return kVoxelKindNames[static_cast<std::size_t>(kind)].second; }

std::optional<VoxelKind> voxel_kind(const std::string& name) {
  for (const auto& [kind, its_name] : kVoxelKindNames)
    if (name == its_name) return kind;
  return std::nullopt;
}

std::size_t voxel_bytes(VoxelKind kind) {
  return with_type(kind, [](auto number) { return sizeof(number); });
}

void append_voxels(VoxelKind kind, const void* data, std::size_t first, std::size_t stride, std::size_t count,
                   std::vector<float>& values) {
  with_type(kind, [&](auto number) {
    const auto* bytes = static_cast<const char*>(data) + first * sizeof(number);
    values.reserve(values.size() + count);
    for (std::size_t k = 0; k < count; ++k) {
      std::memcpy(&number, bytes + k * stride * sizeof(number), sizeof(number));
      values.push_back(static_cast<float>(number));
    }
  });
}

std::vector<char> voxels_as(VoxelKind kind, const std::vector<float>& values) {
  return with_type(kind, [&](auto type) {
    std::vector<char> bytes(values.size() * sizeof(type));
    for (std::size_t k = 0; k < values.size(); ++k) {
      const auto number = nearest<decltype(type)>(values[k]);
      std::memcpy(bytes.data() + k * sizeof(type), &number, sizeof(type));
    }
    return bytes;
  });
}

}  // namespace coapt
