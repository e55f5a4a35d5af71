// A file as its reader finds it, before anything is judged.
#pragma once

#include "core/types.hpp"
#include "image/voxel_kind.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace coapt {

struct FoundImage {
  std::string format;
  std::vector<std::size_t> size;  // voxels along each axis, time the last of four
  std::vector<double> spacing;    // of each axis [mm]
  Vec3 origin = Vec3::Zero();     // in LPS [mm]; missing coordinates are 0
  Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();
  std::size_t components = 1;  // numbers of a voxel
  bool is_list = false;        // components are frames of a sequence
  std::string pixel;           // "scalar", "rgb", "vector", ...
  VoxelKind kind = VoxelKind::UInt8;
  bool states_spacing = true, states_direction = true, states_space = true;
};

}  // namespace coapt
