// Motions that keep shapes: rotation, translation and, where it is asked for, one scale.
#pragma once

#include "core/types.hpp"

namespace coapt {

// x -> scale * rotation * x + translation.
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  // proper: its determinant is +1
  Vec3 translation = Vec3::Zero();                         // [length]
  double scale = 1;

  Points apply(const Points& x) const;
  Eigen::Matrix4d matrix() const;  // acts on (x, y, z, 1)
  RigidMotion inverse() const;
  double angle_deg() const;  // of the rotation, 0 to 180
};

struct RigidFit {
  RigidMotion motion;
  double rms = 0;           // what is left between the moved points and their targets [length]
  double mirrored_rms = 0;  // the same when the points may be mirrored as well [length]
  double flatness = 0;      // second extent of the points over the first, 0 to 1; 0: all on one line
};

// The motion that brings points nearest to their targets, in weighted least squares (Kabsch 1976; with scale
// Umeyama 1991, equations 39 to 42). 3 x n each; weights: n values >= 0, empty for equal ones. A mirror image
// is never made of the points: mirrored_rms tells what it would have left. Points on one line leave the
// turn about it open; flatness says so. Throws InputError for unequal numbers or fewer than three points.
RigidFit fit_rigid(const Points& points, const Points& targets, const Vector& weights = {},
                   bool with_scale = false);

// Whether a fit says that the points are a mirror image of their targets: mirrored they leave less than half,
// and unmirrored more than a thousandth of `size` [length].
bool is_mirror_image(double rms, double mirrored_rms, double size);

}  // namespace coapt
