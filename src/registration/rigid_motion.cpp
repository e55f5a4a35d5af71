#include "registration/rigid_motion.hpp"

#include "core/error.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr double kMirroredShare = 0.5;  // of the rms, below which the mirror image is the better fit
constexpr double kNoticeable = 1e-3;    // of the size: a fit as close as this is no mirror image

}  // namespace

Points RigidMotion::apply(const Points& x) const { return (scale * (rotation * x)).colwise() + translation; }

Eigen::Matrix4d RigidMotion::matrix() const {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = scale * rotation;
  m.topRightCorner<3, 1>() = translation;
  return m;
}

RigidMotion RigidMotion::inverse() const {
  const Eigen::Matrix3d back = rotation.transpose();
  return {back, -(back * translation) / scale, 1 / scale};
}

double RigidMotion::angle_deg() const { return Eigen::AngleAxisd(rotation).angle() * 180 / std::numbers::pi; }

RigidFit fit_rigid(const Points& points, const Points& targets, const Vector& weights, bool with_scale) {
  const Eigen::Index n = points.cols();
  if (targets.cols() != n)
    throw InputError(std::to_string(n) + " points, but " + std::to_string(targets.cols()) +
                     " targets; each point needs one");
  if (n < 3)
    throw InputError(std::to_string(n) + " points; a rigid motion needs three that are not on one line");
  Vector w = weights.size() > 0 ? weights : Vector::Ones(n);
  w /= w.sum();
  const Vec3 from = points * w, to = targets * w;
  const Points x = points.colwise() - from, y = targets.colwise() - to;
  const Eigen::Matrix3d covariance = y * w.asDiagonal() * x.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handed = svd.matrixU().determinant() * svd.matrixV().determinant() < 0 ? -1 : 1;
  const Vec3& values = svd.singularValues();
  const Vec3 signs(1, 1, handed);

  RigidFit fit;
  fit.motion.rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  const double spread = x.colwise().squaredNorm() * w, target_spread = y.colwise().squaredNorm() * w;
  if (with_scale && spread > 0) fit.motion.scale = values.dot(signs) / spread;
  fit.motion.translation = to - fit.motion.scale * (fit.motion.rotation * from);
  fit.rms = std::sqrt(((fit.motion.apply(points) - targets).colwise().squaredNorm() * w).value());
  // The same sum of squares with the sign of the last axis free to choose.
  const double trace = values[0] + values[1] - handed * values[2];
  const double scale = with_scale && spread > 0 ? trace / spread : 1;
  fit.mirrored_rms = std::sqrt(std::max(0.0, scale * scale * spread + target_spread - 2 * scale * trace));
  const Eigen::Matrix3d extents = x * w.asDiagonal() * x.transpose();
  const Vec3 squared = Eigen::JacobiSVD<Eigen::Matrix3d>(extents).singularValues();
  fit.flatness = squared[0] > 0 ? std::sqrt(squared[1] / squared[0]) : 0;
  return fit;
}

bool is_mirror_image(double rms, double mirrored_rms, double size) {
  return rms > kNoticeable * size && mirrored_rms < kMirroredShare * rms;
}

}  // namespace coapt
