// A volume image: numbers on a regular grid that stands anywhere in space.
#pragma once

#include "core/types.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace coapt {

// Positions are in LPS [mm], as in DICOM and as in a scene: voxel (i, j, k) has its centre at
// origin + direction * (i * spacing[0], j * spacing[1], k * spacing[2]).
struct Volume {
  std::array<int, 3> size = {0, 0, 0};                      // voxels along i, j, k
  Vec3 origin = Vec3::Zero();                               // centre of the first voxel [mm]
  Vec3 spacing = Vec3::Ones();                              // between centres [mm]
  Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();  // columns: unit vectors of i, j, k, orthogonal
  std::vector<float> values;                                // i fastest, then j, then k

  std::size_t voxel(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size[0]) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(size[1]) * k);
  }
};

// Same grid, every value `value`.
Volume volume_like(const Volume& grid, float value);

// The centre of a voxel, or any place between, given in voxels [mm].
Vec3 position_of(const Volume& volume, const Vec3& voxels);

// Where a position [mm] lies, in voxels; the inverse of position_of.
Vec3 voxels_of(const Volume& volume, const Vec3& position);

// Trilinear interpolation at a position [mm]; `outside` beyond the outermost centres.
double sample(const Volume& volume, const Vec3& position, double outside);

}  // namespace coapt
