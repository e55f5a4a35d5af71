// Kinds of numbers that files of volumes hold.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

enum class VoxelKind { UInt8, Int8, UInt16, Int16, UInt32, Int32, UInt64, Int64, Float32, Float64 };

// "uint8", "float32", ...
std::string voxel_kind_name(VoxelKind kind);

// The kind of such a name; nothing for other texts.
std::optional<VoxelKind> voxel_kind(const std::string& name);

// Bytes of one voxel.
std::size_t voxel_bytes(VoxelKind kind);

// The numbers at places first, first + stride, ... of `data`, `count` of them, appended to `values`; those of
// 32 and more bits are rounded to single precision. Pre: data holds them all.
void append_voxels(VoxelKind kind, const void* data, std::size_t first, std::size_t stride, std::size_t count,
                   std::vector<float>& values);

// The bytes of these values in this kind: for whole numbers rounded to the nearest one that the kind can
// hold. Pre: values are finite, or the kind is a floating one.
std::vector<char> voxels_as(VoxelKind kind, const std::vector<float>& values);

}  // namespace coapt
