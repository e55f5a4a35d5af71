#include "image/template/spline_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace coapt {
namespace {

// The four cubic B-splines that are not zero at a place along one axis, with two derivatives, and the voxels
// that they belong to.
struct Taps {
  std::array<int, 4> voxel;
  std::array<double, 4> value, slope, bend;
};

Taps taps_at(double at, int size) {
  const double floor = std::floor(at), t = at - floor, s = 1 - t;
  const int first = static_cast<int>(std::clamp(floor, -4.0, size + 4.0)) - 1;
  Taps taps;
  for (int k = 0; k < 4; ++k) taps.voxel[static_cast<size_t>(k)] = std::clamp(first + k, 0, size - 1);
  taps.value = {s * s * s / 6, (4 - 6 * t * t + 3 * t * t * t) / 6, (4 - 6 * s * s + 3 * s * s * s) / 6,
                t * t * t / 6};
  taps.slope = {-s * s / 2, -2 * t + 1.5 * t * t, 2 * s - 1.5 * s * s, t * t / 2};
  taps.bend = {s, 3 * t - 2, 3 * s - 2, t};
  return taps;
}

}  // namespace

double SplineField::at(const Vec3& position, Vec3* gradient, Eigen::Matrix3d* hessian) const {
  const Vec3 voxels = voxels_of(volume_, position);
  const Taps x = taps_at(voxels[0], volume_.size[0]), y = taps_at(voxels[1], volume_.size[1]),
             z = taps_at(voxels[2], volume_.size[2]);
  double value = 0;
  Vec3 g = Vec3::Zero();
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  for (size_t k = 0; k < 4; ++k)
    for (size_t j = 0; j < 4; ++j) {
      const float* row = &volume_.values[volume_.voxel(0, y.voxel[j], z.voxel[k])];
      double f = 0, fx = 0, fxx = 0;
      for (size_t i = 0; i < 4; ++i) {
        const double c = row[x.voxel[i]];
        f += x.value[i] * c;
        fx += x.slope[i] * c;
        fxx += x.bend[i] * c;
      }
      const double yz = y.value[j] * z.value[k];
      value += yz * f;
      if (gradient == nullptr) continue;
      g += Vec3(yz * fx, y.slope[j] * z.value[k] * f, y.value[j] * z.slope[k] * f);
      if (hessian == nullptr) continue;
      h(0, 0) += yz * fxx;
      h(1, 0) += y.slope[j] * z.value[k] * fx;
      h(2, 0) += y.value[j] * z.slope[k] * fx;
      h(1, 1) += y.bend[j] * z.value[k] * f;
      h(2, 1) += y.slope[j] * z.slope[k] * f;
      h(2, 2) += y.value[j] * z.bend[k] * f;
    }
  const Eigen::Matrix3d to_space = volume_.direction * volume_.spacing.cwiseInverse().asDiagonal();
  if (gradient != nullptr) *gradient = to_space * g;
  if (hessian != nullptr)
    *hessian = to_space * Eigen::Matrix3d(h.selfadjointView<Eigen::Lower>()) * to_space.transpose();
  return value;
}

}  // namespace coapt
