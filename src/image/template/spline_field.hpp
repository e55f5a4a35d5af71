// A volume as a smooth function of the place.
#pragma once

#include "image/volume.hpp"

namespace coapt {

// The values of the voxels are the coefficients of a tricubic B-spline: a smoothing, by 0.58 voxels, that
// never overshoots. Twice continuously differentiable everywhere; beyond the volume its outermost voxels go
// on for ever.
class SplineField {
 public:
  explicit SplineField(Volume coefficients) : volume_(std::move(coefficients)) {}

  // The value at a place [mm], its gradient [1/mm] and Hessian [1/mm^2]; null: not wanted.
  double at(const Vec3& position, Vec3* gradient = nullptr, Eigen::Matrix3d* hessian = nullptr) const;

 private:
  Volume volume_;
};

}  // namespace coapt
